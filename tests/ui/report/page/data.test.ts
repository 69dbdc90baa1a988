// Packed arrays: what the page unpacks is what was packed, by a compressor that is not ours and by frames written by hand.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { type Packed, unpack } from "../src/data.ts";
import { pack } from "./fixture.ts";
import { new_seed, random_of } from "./mesh_checks.ts";

const k_limits = { u8: [0, 255], i8: [-128, 127], u16: [0, 65535], i16: [-32768, 32767] } as const;

test("raw frames give back every type, with and without differences", (t) => {
  const seed = new_seed();
  t.diagnostic(`CAVUM_TEST_SEED=${seed}`);
  const random = random_of(seed);
  for (const type of ["u8", "i8", "u16", "i16"] as const)
    for (const delta of [false, true])
      for (const n of [0, 1, 7, 70_000]) {
        const [low, high] = k_limits[type];
        const values = Array.from(
          { length: n },
          () => low + Math.floor(random() * (high - low + 1)),
        );
        assert.deepEqual(
          [...unpack(pack(type, values, delta))],
          values,
          `${type}, delta ${delta}, ${n} values`,
        );
      }
});

test("differences wrap around at the type's ends", () => {
  assert.deepEqual([...unpack({ ...pack("u8", [250, 10, 250]), delta: true })], [250, 4, 254]);
  assert.deepEqual(
    [...unpack({ ...pack("i16", [32767, 1, -1]), delta: true })],
    [32767, -32768, 32767],
  );
});

test("frames compressed by libzstd are unpacked", (t) => {
  const script = `
import base64, json, struct, zstandard
values = [(i // 7 + (i % 13) * 5) % 65536 for i in range(200000)]
raw = struct.pack("<%dH" % len(values), *values)
print(json.dumps([base64.b64encode(zstandard.ZstdCompressor(level=level).compress(raw)).decode() for level in (1, 3, 9, 19)]))`;
  const run = ["/usr/bin/python3", "python3"]
    .map((python) => spawnSync(python, ["-c", script], { encoding: "utf8", maxBuffer: 1 << 28 }))
    .find(({ status }) => status === 0);
  if (!run) return t.skip("python3-zstandard is not installed");
  const expected = Array.from(
    { length: 200_000 },
    (_, i) => (Math.floor(i / 7) + (i % 13) * 5) % 65536,
  );
  for (const zstd of JSON.parse(run.stdout) as string[]) {
    assert.ok(zstd.length < 400_000, "it was compressed at all");
    assert.deepEqual([...unpack({ type: "u16", n: 200_000, delta: false, zstd })], expected);
  }
});

test("an array of another length than announced is refused", () => {
  const packed: Packed = pack("u16", [1, 2, 3]);
  assert.throws(() => unpack({ ...packed, n: 2 }), /2 values of u16 announced, 6 bytes found/);
  assert.throws(() => unpack({ ...packed, type: "u8" }), /announced/);
});

test("the bundle holds the licences of what is in it, and nothing that ends its element or needs more than the page may do", () => {
  const script = readFileSync("page.js", "utf8");
  const style = readFileSync("page.css", "utf8");
  const licences = script.slice(script.lastIndexOf("\n/*"));
  for (const name of ["three", "uplot", "fzstd"])
    assert.match(licences, new RegExp(`^${name} \\d+\\.\\d+\\.\\d+\\n[\\s\\S]*?MIT`, "m"));
  assert.match(licences, /Permission is hereby granted, free of charge/);
  assert.match(style, /uplot \d+\.\d+\.\d+\n/);
  assert.doesNotMatch(script + style, /<\/(script|style)|<!--/i);
  assert.doesNotMatch(style, /@import|url\((?!['"]?data:)/);
  assert.doesNotMatch(script.slice(0, script.lastIndexOf("\n/*")), /[^.\w]eval\(|new Function\(/);
  assert.ok(script.length < 1_000_000, `${script.length} bytes`);
});
