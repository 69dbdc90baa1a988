#include "grading/records/finding.h"

#include "engine/base/json_fields.h"
#include "engine/base/json_struct.h"
#include "engine/base/message_json.h"
#include "grading/marking/school_mark.h"

namespace cavum::records {

using nlohmann::json;

Findings findings_of(FindingKind kind, const std::vector<Message>& messages) {
  Findings out;
  for (const Message& m : messages) out.push_back({kind, m});
  return out;
}

Findings findings_of(const grading::SchoolMark& mark) {
  const bool open = mark.replay.intact && !mark.replay.closed;  // and nothing else is wrong
  Findings out = findings_of(open ? FindingKind::not_closed : FindingKind::recording_unsound, words_of(mark.replay.findings));
  append(out, findings_of(FindingKind::exam_differs, mark.exam));
  if (!mark.other_result.empty()) out.push_back({FindingKind::result_differs, mark.other_result});
  return out;
}

std::vector<Message> words_of(const Findings& findings) {
  std::vector<Message> out;
  for (const Finding& f : findings) out.push_back(f.what);
  return out;
}

Findings named(const Message& before, Findings findings) {
  for (Finding& f : findings) f.what = msg("{}: {}", before, f.what);
  return findings;
}

void append(Findings& to, const Findings& more) { to.insert(to.end(), more.begin(), more.end()); }

void to_json(json& j, const Finding& finding) {
  j = fact_json(name_in(finding.kind), finding.what);
  if (finding.entry) j["entry"] = *finding.entry;
}

json write_json(const Finding& f) {
  json out = encode(f.what);
  out["kind"] = to_json_value(f.kind);
  return out;
}

void read_json(const json& from, const JsonPlace& at, Finding& f) {
  read_json_value(member_of(from, "kind"), at.member("kind"), f.kind);
  read_json_value(from, at, f.what);
}

}  // namespace cavum::records
