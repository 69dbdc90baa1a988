// What the desk tells of results to learning platforms, and to whoever comes from one.
#include "engine/base/json_fields.h"
#include "grading/records/erasure.h"
#include "grading/records/exam_scale.h"
#include "grading/records/exported_grade.h"
#include "grading/result/result_json.h"
#include "ui/office/desk.h"
#include "ui/office/desk_parts.h"
#include "ui/office/desk_turn.h"

namespace cavum::office {

namespace {

bool is_own(records::Identities& identities, const records::FiledSession& s,
            const std::string& number) {
  const auto identity = identities.of_pseudonym(s.candidate);
  return !number.empty() && identity && identity->id == number;
}

}  // namespace

std::size_t Desk::entries() {
  Turn turn(*this);
  return turn.book.content().entries.size();
}

std::set<std::string> Desk::numbers() {
  Turn turn(*this);
  std::set<std::string> out;
  for (const auto& one : records::sound_identities(turn.book).all()) out.insert(one.id);
  return out;
}

std::vector<records::ScoreDue> Desk::scores_due(const std::string& exam,
                                                const std::string& line_item, bool again) {
  Turn turn(*this);
  records::Identities identities = records::sound_identities(turn.book);
  return records::scores_due(turn.book.content(), turn.book.registry(), identities, exam, line_item,
                             in_words, again);
}

void Desk::enter_passback(const records::ScoreDue& sent, const std::string& platform,
                          const std::string& line_item, int status, const std::string& answer) {
  Turn turn(*this);
  records::enter_passback(turn.book, sent, platform, line_item, status, answer);
}

std::pair<int, int> Desk::passbacks(const std::string& line_item) {
  Turn turn(*this);
  std::map<std::uint64_t, bool> last;  // by session
  for (const auto& p : turn.book.registry().passbacks)
    if (p.line_item == line_item) last[p.session] = p.accepted();
  std::pair<int, int> out{0, 0};
  for (const auto& [session, accepted] : last) ++(accepted ? out.first : out.second);
  return out;
}

std::vector<OwnResult> Desk::own_results(const std::string& number, const std::string& exam) {
  Turn turn(*this);
  records::Identities identities = records::sound_identities(turn.book);
  const auto scales = records::own_scales(turn.book.registry());
  const auto counting = turn.book.registry().counting();
  std::vector<OwnResult> out;
  for (const auto& s : turn.book.registry().sessions) {
    if (!s.shown->is_object() || (!exam.empty() && s.scenario_id != exam) ||
        !is_own(identities, s, number))
      continue;
    const records::ExportedGrade grade = records::exported_grade(s, scales);
    out.push_back({s.scenario_id, grading::verdict_in(*s.shown),
                   number_in(grade.points).value_or(0), number_in(grade.max).value_or(0),
                   local_text(s.released_utc_ns),
                   counting.at({s.candidate, s.scenario_id}) == s.seq, !s.simulated.empty(),
                   s.motion_erased_by || s.result_erased_by ? "" : s.file_sha256});
  }
  return out;
}

Recording Desk::own_recording(const std::string& number, const std::string& file_sha256) {
  Turn turn(*this);
  records::Identities identities = records::sound_identities(turn.book);
  for (const auto& s : turn.book.registry().sessions)
    if (s.file_sha256 == file_sha256 && s.shown->is_object() && is_own(identities, s, number))
      return {records::recording_of(turn.book.places(), s), turn.book.content().entries.size()};
  throw Error(msg("this report"), msg("is not there"), msg("open the link on the platform again"));
}

}  // namespace cavum::office
