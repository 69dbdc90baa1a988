#include "grading/marking/exam_context.h"

#include <algorithm>

#include "engine/base/hash.h"
#include "engine/tooth/tooth.h"
#include "scenarios/zones/placed.h"

namespace cavum::grading {
namespace {

constexpr std::size_t k_kept = 4;  // some 50 MB each at 0.05 mm

/// SHA-256 of all that tooth and zones are made from.
std::string content_of(const SessionSetup& session) {
  ByteWriter all;
  all.put_bytes(sha256(session.scenario_toml));
  all.put_bytes(sha256(session.tooth));
  all.put_bytes(sha256(session.landmarks_json));
  for (const auto& [name, bytes] : session.attachments) {
    all.put_string(name);
    all.put_bytes(sha256(bytes));
  }
  return to_hex(sha256(all.bytes()));
}

}  // namespace

ExamContext::ExamContext(Tooth tooth_before, scenarios::ZoneMap zones_of_it, KnownFits fits_of_it)
    : tooth(std::move(tooth_before)),
      fits(std::move(fits_of_it)),
      hash(tooth_hash(tooth)),
      zones(std::move(zones_of_it)),
      apart(take_apart(tooth)),
      known(tooth, apart ? apart->own : tooth) {}

ExamContexts::ExamContexts(const scenarios::ExamSetup& exam) {
  by_content_[content_of(exam.session)] = {
      std::make_shared<const ExamContext>(exam.tooth, exam.zones), ++asked_};
}

std::shared_ptr<const ExamContext> ExamContexts::of(const scenarios::ExamTask& task,
                                                    const std::string& where) {
  const std::string content = content_of(task.session);
  const std::lock_guard lock(mutex_);
  Kept& kept = by_content_[content];
  if (!kept.ground) {
    try {
      KnownFits fits;
      Tooth tooth = load_tooth_like(task.session.tooth, where + ": tooth", nullptr, &fits);
      scenarios::ZoneMap zones =
          scenarios::build_zones_of_exam(task.scenario, tooth, task.session.landmarks_json, where);
      kept.ground =
          std::make_shared<const ExamContext>(std::move(tooth), std::move(zones), std::move(fits));
    } catch (...) {
      by_content_.erase(content);
      throw;
    }
  }
  kept.asked = ++asked_;
  auto ground = kept.ground;
  if (by_content_.size() > k_kept)
    by_content_.erase(std::min_element(
        by_content_.begin(), by_content_.end(),
        [](const auto& a, const auto& b) { return a.second.asked < b.second.asked; }));
  return ground;
}

}  // namespace cavum::grading
