// All tickets with their state and seat; one that lives can be cancelled, with a reason. Sittings are seated at once, and papers printed.
import { routes, type StationShown, type TicketRow } from "../made/routes.ts";
import { make } from "../report_src/dom.ts";
import { tr } from "../report_src/words.ts";
import { download, get, post, type May } from "./api.ts";
import { with_makeup } from "./makeup.ts";
import {
  act,
  form,
  length_words,
  local_span,
  say,
  select,
  table,
  time_zone,
  with_reason,
  type View,
} from "./parts.ts";

export async function tickets(may: May): Promise<View> {
  const root = make("div", {}, make("h1", {}, tr("Tickets")));
  const list = make("div"),
    lengths = make("ul");
  const sittings = make("div");
  const show = async (): Promise<void> => {
    const [{ tickets, exams }, { stations }] = await Promise.all([
      get(routes.tickets),
      get(routes.board),
    ]);
    if (tickets.length === 0)
      return void list.replaceChildren(
        make("p", {}, tr("There is no ticket yet. Begin with the class list.")),
      );
    lengths.replaceChildren(
      ...exams.map((e) =>
        make("li", {}, `${e.title} (${e.id}): ${length_words(e.time_limit_s, e.longest_s ?? 0)}`),
      ),
    );
    const names = new Map(stations.map((s) => [s.public_key, s.name]));
    const rows = tickets.map((t) => {
      const cancel = t.live && may(routes.cancel_ticket) ? with_cancel(t, show) : "";
      const actions = make(
        "div",
        { class: "row" },
        cancel,
        ...(t.makeup.length > 0 && may(routes.make_up) ? [with_makeup(t, show)] : []),
      );
      const state =
        t.live && !t.at_station
          ? make(
              "span",
              { class: "wrong" },
              tr("{}; its file is lost: cancel it, and issue another", t.state),
            )
          : t.became === "missed"
            ? tr("missed; {}", t.state)
            : t.became !== ""
              ? tr("interrupted; {}", t.state)
              : t.why === ""
                ? t.state
                : tr("{0}. Reason: {1}", t.state, t.why);
      const seat = t.live && may(routes.seats) ? seat_of(t, stations) : (names.get(t.seat) ?? "");
      const name =
        (t.accommodations ?? "") === ""
          ? t.name
          : make("div", {}, t.name, make("div", { class: "hint" }, t.accommodations!));
      return [
        t.id,
        name,
        t.candidate,
        t.exam,
        local_span(t.not_before, t.not_after),
        seat,
        state,
        actions.textContent === "" ? "" : actions,
      ];
    });
    const headings = [
      tr("Number"),
      tr("Name"),
      tr("Pseudonym"),
      tr("Exam"),
      tr("May begin"),
      tr("Station"),
      tr("State"),
      tr("Action"),
    ];
    list.replaceChildren(
      table(tr("Tickets: {0}; times in {1}", tickets.length, time_zone()), headings, rows),
    );
    sittings.replaceChildren(
      ...(may(routes.seats)
        ? seatings(
            tickets.filter((t) => t.live),
            stations,
            show,
          )
        : []),
    );
  };
  await show();
  root.append(act(tr("Look again"), {}, show), lengths, papers(may), sittings, list);
  return { root };
}

function papers(may: May): HTMLElement {
  const links = make("ul");
  for (const [route, name, text] of [
    [routes.cards, "cards.pdf", tr("Candidate cards (PDF)")],
    [routes.sign_in_sheet, "sign-in-sheet.pdf", tr("Sign-in sheet (PDF)")],
  ] as const)
    if (may(route)) {
      const link = make("a", { href: route.path, download: name }, text);
      link.addEventListener("click", (event) => {
        // by itself a link says nothing of why there is no paper
        event.preventDefault();
        say("");
        download(route, name).catch((wrong: Error) => say(wrong.message, true));
      });
      links.append(make("li", {}, link));
    }
  return links;
}

function with_cancel(t: TicketRow, show: () => Promise<void>): HTMLElement {
  return with_reason(
    tr("Cancel"),
    { class: "bad", "aria-label": tr("Cancel the ticket of {}", t.candidate) },
    async (reason) => {
      try {
        await post(routes.cancel_ticket, { entry: t.entry, reason, begun: t.begun });
      } catch (wrong) {
        await show(); // it may have begun since the list was made
        throw wrong;
      }
      await show();
      say(tr("The ticket of {} does not count any more.", t.candidate));
    },
    {
      sends: tr("Cancel the ticket"),
      asked: t.begun
        ? [
            make(
              "p",
              { class: "wrong" },
              tr(
                "This candidate has begun. What is handed in will be refused. A makeup sitting keeps it on record.",
              ),
            ),
          ]
        : [],
    },
  );
}

function seat_of(t: TicketRow, stations: StationShown[]): HTMLElement {
  const list = select(
    tr("Station"),
    [
      ["", tr("any")],
      ...stations.filter((s) => !s.revoked).map((s): [string, string] => [s.public_key, s.name]),
    ],
    t.seat,
  );
  list.block.querySelector("label")!.remove();
  list.setAttribute("aria-label", tr("Station of {}", t.candidate));
  list.addEventListener("change", () => {
    post(routes.seats, { ticket: t.entry, station: list.value })
      .then(() => say(tr("{} has another station.", t.candidate)))
      .catch((wrong: Error) => {
        list.value = t.seat; // it stays where it was
        say(wrong.message, true);
      });
  });
  return list.block;
}

/** A sitting is all tickets of one exam and time; who has no seat in it gets one with one press. */
function seatings(
  live: TicketRow[],
  stations: StationShown[],
  show: () => Promise<void>,
): HTMLElement[] {
  const key = (t: TicketRow): string => JSON.stringify([t.exam, t.not_before, t.not_after]);
  const open = live.filter((t) => t.seat === "");
  if (open.length === 0) return [];
  const keys = [...new Set(open.map(key))].sort((a, b) =>
    (JSON.parse(a) as string[])[1].localeCompare((JSON.parse(b) as string[])[1]),
  );
  const rooms = [
    ...new Set(stations.filter((s) => !s.revoked && s.room !== "").map((s) => s.room)),
  ].sort();
  const sitting = select(
    tr("Sitting"),
    keys.map((k): [string, string] => {
      const [exam, not_before, not_after] = JSON.parse(k) as [string, string, string];
      return [k, `${local_span(not_before, not_after)}, ${exam}`];
    }),
  );
  const room = select(tr("Room"), [["", tr("any")], ...rooms.map((r): [string, string] => [r, r])]);
  const without = make("p");
  const count = (): void => {
    const here = (t: TicketRow): boolean => key(t) === sitting.value;
    without.textContent = tr(
      "Without a station: {0} of {1}",
      open.filter(here).length,
      live.filter(here).length,
    );
  };
  sitting.addEventListener("change", count);
  count();
  return [
    make(
      "section",
      { class: "card", "aria-label": tr("Seats") },
      make("h2", {}, tr("Seats")),
      form(
        tr("Seat them"),
        async () => {
          const [exam, not_before, not_after] = JSON.parse(sitting.value) as [
            string,
            string,
            string,
          ];
          const done = await post(routes.seats, {
            sitting: { exam, not_before, not_after },
            room: room.value,
          });
          await show();
          say(
            tr("Seated: {0}. Without a station still: {1}.", done.seated, done.left),
            done.left > 0,
          );
        },
        sitting.block,
        without,
        room.block,
      ),
    ),
  ];
}
