#include "ui/office/papers.h"

#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <tuple>

#include "engine/base/error.h"
#include "engine/session/session.h"
#include "ui/language/language.h"
#include "ui/language/say.h"
#include "ui/office/desk_parts.h"
#include "ui/report/print/pdf_writer.h"

namespace cavum::office {
namespace {

struct Local {
  std::string day, time, zone;
};

Local local_of(std::int64_t utc_ns) {
  const std::time_t seconds = static_cast<std::time_t>(utc_ns / 1'000'000'000);
  std::tm t{};
  ::localtime_r(&seconds, &t);
  const long minutes = t.tm_gmtoff / 60;
  return {fmt::format("{:04}-{:02}-{:02}", t.tm_year + 1900, t.tm_mon + 1, t.tm_mday),
          fmt::format("{:02}:{:02}", t.tm_hour, t.tm_min),
          fmt::format("{} (UTC{}{:02}:{:02})", t.tm_zone, minutes < 0 ? '-' : '+',
                      std::labs(minutes) / 60, std::labs(minutes) % 60)};
}

/// "2026-11-21 09:00 to 12:00 CET (UTC+01:00)"
std::string span_text(std::int64_t from_utc_ns, std::int64_t until_utc_ns) {
  const Local from = local_of(from_utc_ns), until = local_of(until_utc_ns);
  return tr("{} {} to {} {}", as_is(from.day), as_is(from.time),
            as_is(from.day == until.day ? until.time : until.day + " " + until.time),
            as_is(until.zone));
}

std::string exam_name(const Invited& i) {
  return i.title.empty() ? i.exam : fmt::format("{} ({})", i.title, i.exam);
}

report::Document paper(const std::string& title, const std::string& school,
                       const std::vector<Invited>& people) {
  if (people.empty())
    throw Error(msg("the paper"), msg("would be empty: no ticket is good"),
                msg("issue tickets first"));
  report::Document d;
  d.title = title;
  d.language = language();
  const std::int64_t now = read_clocks().utc_ns;
  d.created = utc_text(now);
  d.subtitle = tr("{}; printed {}", as_is(school), as_is(local_text(now)));
  d.footer = {d.subtitle};
  return d;
}

}  // namespace

std::string local_text(std::int64_t utc_ns) {
  const Local l = local_of(utc_ns);
  return fmt::format("{} {} {}", l.day, l.time, l.zone);
}

std::vector<Invited> invited(records::Ledger& ledger, std::int64_t now) {
  const records::Registry& registry = ledger.registry();
  const auto people = people_of(ledger);
  std::vector<Invited> out;
  for (const auto& t : registry.tickets) {
    if (!t.live(now)) continue;
    Invited i{.code = t.ticket.candidate,
              .nonce = t.ticket.nonce,
              .exam = t.ticket.exam,
              .from_utc_ns = t.ticket.not_before_utc_ns,
              .until_utc_ns = t.ticket.not_after_utc_ns};
    if (const auto who = people.find(t.ticket.candidate); who != people.end())
      i.id = who->second.id, i.name = who->second.name;
    if (const records::Station* s = registry.stations.of(t.seat); s != nullptr)
      i.room = s->room, i.station = s->name;
    out.push_back(std::move(i));
  }
  const auto order = [](const Invited& i) {
    return std::tie(i.from_utc_ns, i.until_utc_ns, i.exam, i.room, i.station, i.id);
  };
  std::sort(out.begin(), out.end(),
            [&](const Invited& a, const Invited& b) { return order(a) < order(b); });
  return out;
}

std::string candidate_cards(const std::string& school, const std::vector<Invited>& people) {
  report::Document d = paper(tr("Candidate cards"), school, people);
  constexpr double k_card_pt = 110;
  for (const auto& i : people) {
    d.blocks.push_back(report::CutLine{k_card_pt});
    d.blocks.push_back(report::Heading{i.code});
    d.blocks.push_back(report::Paragraph{
        fmt::format("{}{}", i.name, i.name.empty() ? i.id : fmt::format(" ({})", i.id)),
        tr("For")});
    d.blocks.push_back(
        report::Paragraph{span_text(i.from_utc_ns, i.until_utc_ns), tr("May begin")});
    if (!i.station.empty())
      d.blocks.push_back(report::Paragraph{
          i.room.empty() ? i.station : fmt::format("{}, {}", i.room, i.station), tr("Place")});
    if (!i.accommodations.empty())
      d.blocks.push_back(report::Paragraph{i.accommodations, tr("Granted")});
    d.blocks.push_back(report::Paragraph{
        tr("Type this code at the station, never your name. Exam: {}", as_is(exam_name(i))), "",
        report::Paragraph::Kind::small});
  }
  return report::pdf_of(d);
}

std::string sheet_to_sign(const std::string& school, const std::vector<Invited>& people) {
  report::Document d = paper(tr("Sign-in sheet"), school, people);
  constexpr double k_row_pt = 12 / 25.4 * 72;  // 12 mm: room for a hand
  for (std::size_t at = 0; at < people.size();) {
    const Invited& first = people[at];
    d.blocks.push_back(report::Heading{fmt::format("{}: {}{}", exam_name(first),
                                                   span_text(first.from_utc_ns, first.until_utc_ns),
                                                   first.room.empty() ? "" : ", " + first.room)});
    report::ReportTable table{{{tr("Number"), false, 2},
                               {tr("Name"), false, 4},
                               {tr("Code"), false, 4},
                               {tr("Station"), false, 2},
                               {tr("Signature"), false, 4.5}},
                              {},
                              tr("Sign-in sheet"),
                              k_row_pt};
    for (; at < people.size() && people[at].exam == first.exam &&
           people[at].from_utc_ns == first.from_utc_ns &&
           people[at].until_utc_ns == first.until_utc_ns && people[at].room == first.room;
         ++at)
      table.rows.push_back(
          {{{people[at].id}, {people[at].name}, {people[at].code}, {people[at].station}, {""}}});
    d.blocks.push_back(std::move(table));
  }
  return report::pdf_of(d);
}

}  // namespace cavum::office
