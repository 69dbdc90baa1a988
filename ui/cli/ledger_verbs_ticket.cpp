// `cavum ledger ticket | tickets | cancel | begin`: exams that the school promised.
#include <fmt/core.h>

#include <algorithm>

#include "engine/base/file.h"
#include "engine/base/file_name.h"
#include "grading/records/begin.h"
#include "grading/records/candidate_id.h"
#include "grading/records/erasure.h"
#include "grading/records/issue.h"
#include "grading/records/registry.h"
#include "grading/records/ticket_state.h"
#include "scenarios/exam/exam.h"
#include "scenarios/file/accommodations.h"
#include "ui/cli/ledger_verbs_parts.h"
#include "ui/parts/print_json.h"
#include "ui/parts/say.h"

namespace cavum::ui {

using nlohmann::json;

int ledger_ticket(const LedgerOptions& o) {
  if (o.candidate.empty() == o.candidates.empty())
    throw Error(msg("ledger ticket"), msg("needs to know for whom"),
                msg("give either --candidate ID or --candidates FILE.csv"));
  records::require_candidate_id("--candidate", o.candidate);
  records::require_candidate_id("--name", o.name);
  const std::vector<records::Person> people =
      o.candidates.empty()
          ? std::vector<records::Person>{{o.candidate, o.name}}
          : records::parse_people(read_text_file(o.candidates), o.candidates, o.passed_over);
  const std::int64_t from = records::parse_utc(o.from, "--from"),
                     until = records::parse_utc(o.until, "--until");
  if (until <= from)
    throw Error(Name{"--until"}, msg("is not after --from"),
                msg("give the last moment at which the exam may begin"));
  scenarios::ExamOptions exam;
  exam.tooth_file = o.tooth;
  exam.rubric_file = o.rubric;
  exam.force_model = o.model;
  exam.grant = o.grant;
  const auto setup = scenarios::prepare_exam(o.scenario, exam);
  records::Ledger ledger(o.folder, key_of(o));
  records::Identities identities = sound_identities(ledger);
  records::Ticket ticket = records::promise(*setup, ledger.content(), from, until);
  ticket.begun_at_ledger = o.begin_at_ledger;
  const bool folder = !o.candidates.empty();
  if (until < read_clocks().utc_ns) say_error(msg("--until {}: is past already", o.until));
  if (folder) make_private_folder(o.out);
  const auto file_for = [&](const std::string& candidate) {
    return folder ? fmt::format("{}/{}.ticket", o.out, file_name_of(candidate)) : o.out;
  };
  for (const auto& p : people)
    require_new(o, file_for(identities.enrol(p.id, p.name, ticket.exam, ledger.key())));
  json printed = json::array();
  Lines rows;
  int refused = 0;
  const records::ListCommand wish{ticket,
                                  people,
                                  std::vector(people.size(), records::TimeSpan{from, until}),
                                  o.candidates,
                                  0,
                                  people.size(),
                                  o.grant,
                                  o.another ? records::Another::allow : records::Another::refuse};
  const auto issued = records::issue_list(
      ledger, identities, wish, [&](const records::Issued& one, const std::string& text) {
        write_school_file(o, file_for(one.candidate), text + "\n");
      });
  for (const auto& one : issued) {
    const auto& p = one.person;
    if (one.refused) {
      if (!folder) throw *one.refused;
      say_error(msg("{}: {}", p.id, one.refused->message()));
      ++refused;
      continue;
    }
    const std::string file = file_for(one.candidate);
    const Message granted = scenarios::accommodations_text(
        scenarios::granted(setup->scenario.accommodations, one.ticket.grant, msg("the ticket")));
    printed.push_back({{"candidate", one.candidate},
                       {"id", p.id},
                       {"name", p.name},
                       {"accommodations", granted},
                       {"file", file},
                       {"station", p.station}});
    const Message who = p.name.empty() ? msg("{}", p.id) : msg("{}, {}", p.id, p.name);
    rows.row(
        {Name{one.candidate}, Name{file}, granted.empty() ? who : msg("{}; {}", who, granted)});
  }
  if (o.as_json)
    print_json(json{{"tickets", printed}, {"refused", refused}});
  else
    say(rows);
  return refused == 0 ? 0 : 1;
}

void ledger_tickets(const LedgerOptions& o) {
  const records::LedgerContent content = records::read_ledger({o.folder});
  const records::Registry registry = records::read_registry(content);
  const std::int64_t now = read_clocks().utc_ns;
  json printed = json::array();
  Lines rows;
  for (const auto& t : registry.tickets) {
    const records::TicketState state = records::state_of(t, now);
    printed.push_back({{"entry", t.seq},
                       {"candidate", t.ticket.candidate},
                       {"exam", t.ticket.exam},
                       {"not_before", utc_text(t.ticket.not_before_utc_ns)},
                       {"not_after", utc_text(t.ticket.not_after_utc_ns)},
                       {"state", records::name_of(state.group)},
                       {"text", english_text(state.words)}});
    rows.row(
        {msg("{}", t.seq), Name{t.ticket.candidate}, Name{t.ticket.exam},
         msg("{} to {}", utc_text(t.ticket.not_before_utc_ns), utc_text(t.ticket.not_after_utc_ns)),
         state.words},
        2);
  }
  if (o.as_json)
    print_json(json{{"tickets", printed}});
  else
    say(rows);
}

void ledger_cancel(const LedgerOptions& o) {
  if (o.ticket_entry < 0)
    throw Error(Name{"--ticket"}, msg("is no entry's number"),
                msg("see `cavum ledger tickets {}`", o.folder));
  records::Ledger ledger(o.folder, key_of(o));
  const auto& entry =
      records::cancel_ticket(ledger, static_cast<std::uint64_t>(o.ticket_entry), o.reason);
  say(msg(
      "entry {}: the ticket of entry {} does not count any more; an exam that is begun with it is filed with findings only",
      entry.seq, o.ticket_entry));
}

void ledger_begin(const LedgerOptions& o) {
  records::Ledger ledger(o.folder, key_of(o));
  const std::string out = o.out.empty() ? records::begin_path(o.ticket_file) : o.out;
  const records::Ticket ticket =
      records::parse_ticket(read_text_file(o.ticket_file), "", o.ticket_file);
  LedgerOptions writing = o;
  writing.overwrite = o.overwrite || !o.again.empty();  // the word before does not count any more
  require_new(writing, out);
  write_school_file(writing, out, records::let_begin(ledger, ticket.nonce, o.again) + "\n");
  say(msg("written: {}", out));
  say(msg("keep it beside the ticket on the station; the exam of {} may begin now",
          ticket.candidate));
}

}  // namespace cavum::ui
