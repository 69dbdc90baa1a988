// Which moments of two sessions are shown together.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Alignment } from "../src/alignment.ts";

const own = { steps_s: [10, 30], duration_s: 40 };

test("by the clock both are at the same second, and what ended earlier stands", () => {
  const a = new Alignment(own, { steps_s: [5, 20], duration_s: 25 });
  assert.equal(a.time(12), 12);
  assert.equal(a.time(39), 25);
});

test("by steps both are as far into the same step, and back", () => {
  const a = new Alignment(own, { steps_s: [5, 25], duration_s: 55 });
  a.by_step = true;
  for (const [t, other] of [
    [0, 0],
    [5, 2.5],
    [10, 5],
    [20, 15],
    [30, 25],
    [35, 40],
    [40, 55],
  ]) {
    assert.equal(a.time(t), other);
    assert.equal(a.back(other), t);
  }
});

test("steps that only one of them completed are none", () => {
  const a = new Alignment(own, { steps_s: [5], duration_s: 20 });
  a.by_step = true;
  assert.equal(a.time(10), 5);
  assert.equal(a.time(25), 12.5);
  assert.equal(new Alignment(own, { steps_s: [], duration_s: 20 }).has_steps, false);
});
