// All results with what keeps them back, their release with the second factor, and the files for other systems.
import { make } from "../report_src/dom.ts";
import { fixed, tr } from "../report_src/words.ts";
import { get, post } from "./api.ts";
import { form, input, say, table, type View } from "./parts.ts";

interface Result {
  session: number; candidate: string; exam: string; state: string; findings: string[]; simulated: string; verdict: string;
  points: number | null; max: number | null; id?: string; name?: string;
}

const verdicts = (): { [verdict: string]: string } => ({ pass: tr("pass"), fail: tr("fail"), review: tr("review") });
const states = (): { [state: string]: string } => ({
  released: tr("released"), "to decide": tr("waits for a decision"), questioned: tr("questioned: released by name only"), "not chosen": tr("another ending was chosen"),
  erased: tr("erased"), ready: tr("ready for release"),
});

export async function results(may: (door: string) => boolean, second_factor: boolean): Promise<View> {
  const list = make("div");
  const show = async (): Promise<void> => {
    const { results } = await get<{ results: Result[] }>("/api/results");
    if (results.length === 0) return void list.replaceChildren(make("p", {}, tr("Nothing is filed yet.")));
    const named = results.some((r) => r.id !== undefined);
    const words = states();
    const rows = results.map((r) => [
      String(r.session), ...(named ? [r.id ?? "", r.name ?? ""] : []), r.candidate, r.exam, verdicts()[r.verdict] ?? r.verdict,
      r.points === null ? "" : tr("{0} of {1}", fixed(r.points, 1), r.max ?? ""),
      [words[r.state] ?? r.state, ...(r.simulated !== "" ? [tr("simulated")] : []), ...r.findings].join("; "),
    ]);
    const headings = [tr("Entry"), ...(named ? [tr("Number"), tr("Name")] : []), tr("Pseudonym"), tr("Exam"), tr("Verdict"), tr("Points"), tr("State")];
    list.replaceChildren(table(tr("Results: {}", results.length), headings, rows));
  };
  await show();
  const root = make("div", {}, make("h1", {}, tr("Results")), list);
  if (may("POST /api/release")) root.append(release(second_factor, show));
  const files = make("ul");
  if (may("GET /api/gradebook.csv")) files.append(make("li", {}, make("a", { href: "/api/gradebook.csv", download: "gradebook.csv" }, tr("Gradebook (CSV for Moodle), with names: what is released"))));
  if (may("GET /api/criteria.csv")) files.append(make("li", {}, make("a", { href: "/api/criteria.csv", download: "criteria.csv" }, tr("Every criterion (CSV), pseudonyms alone"))));
  root.append(make("h2", {}, tr("Files")), files);
  return { root };
}

function release(second_factor: boolean, show: () => Promise<void>): HTMLElement {
  const section = make("section", {}, make("h2", {}, tr("Release")));
  if (!second_factor) {
    section.append(make("p", { class: "wrong" }, tr("This account has no second factor, and releases nothing.")));
    return section;
  }
  const reason = input(tr("Reason"), { required: "", maxlength: "2000", autocomplete: "off" }, tr("Kept for ever: no names."));
  const code = input(tr("Code of your app"), { required: "", inputmode: "numeric", autocomplete: "one-time-code", pattern: "[0-9]{6}", maxlength: "6" });
  section.append(
    make("p", {}, tr("All results go out that are ready. What waits for a decision, or is questioned, stays.")),
    form(tr("Release all that are ready"), async () => {
      const done = await post<{ released: number; kept_back: number; to_decide: number }>("/api/release", { all: true, reason: reason.value, code: code.value });
      code.value = "";
      await show();
      say(tr("Released: {0}. Questioned: {1}. Waiting for a decision: {2}.", done.released, done.kept_back, done.to_decide));
    }, reason.block, code.block));
  return section;
}
