// All tickets with their state; one that lives can be cancelled, with a reason.
import { make } from "../report_src/dom.ts";
import { tr } from "../report_src/words.ts";
import { get, post } from "./api.ts";
import { act, local_time as local, say, table, time_zone, with_reason, type View } from "./parts.ts";

interface Ticket { entry: number; candidate: string; exam: string; not_before: string; not_after: string; state: string; live: boolean; at_station: boolean; id: string; name: string }

export async function tickets(may_cancel: boolean): Promise<View> {
  const root = make("div", {}, make("h1", {}, tr("Tickets")));
  const list = make("div");
  const show = async (): Promise<void> => {
    const { tickets } = await get<{ tickets: Ticket[] }>("/api/tickets");
    if (tickets.length === 0) return void list.replaceChildren(make("p", {}, tr("There is no ticket yet. Begin with the class list.")));
    const rows = tickets.map((t) => {
      const cancel = t.live && may_cancel ? with_cancel(t, show) : "";
      const state = t.live && !t.at_station ? make("span", { class: "wrong" }, tr("{}; its file is lost: cancel it, and issue another", t.state)) : t.state;
      return [t.id, t.name, t.candidate, t.exam, tr("{0} to {1}", local(t.not_before), local(t.not_after)), state, cancel];
    });
    const headings = [tr("Number"), tr("Name"), tr("Pseudonym"), tr("Exam"), tr("May begin"), tr("State"), tr("Action")];
    list.replaceChildren(table(tr("Tickets: {0}; times in {1}", tickets.length, time_zone()), headings, rows));
  };
  await show();
  root.append(act(tr("Look again"), {}, show), list);
  return { root };
}

function with_cancel(t: Ticket, show: () => Promise<void>): HTMLElement {
  return with_reason(tr("Cancel"), { class: "bad", "aria-label": tr("Cancel the ticket of {}", t.candidate) }, async (reason) => {
    await post("/api/tickets/cancel", { entry: t.entry, reason });
    await show();
    say(tr("The ticket of {} does not count any more.", t.candidate));
  });
}
