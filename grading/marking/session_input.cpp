#include "grading/marking/session_input.h"

#include "engine/base/error.h"
#include "engine/session/chain_check.h"
#include "scenarios/file/accommodations.h"
#include "scenarios/file/parse.h"
#include "scenarios/file/rubric_check.h"
#include "scenarios/file/surface_files.h"
#include "scenarios/zones/placed.h"

namespace cavum::grading {
namespace {

/// `after_of` gives the tooth at the end.
template <class After>
std::unique_ptr<GradedSession> load_with(const SessionReader& reader, ExamContexts& grounds,
                                         const After& after_of) {
  const std::string& path = reader.path();
  auto s = std::make_unique<GradedSession>();
  static_cast<scenarios::ExamTask&>(*s) = scenarios::exam_task(reader.setup(), path + ": scenario");
  const SessionSetup& setup = s->session;
  s->sat_under_ticks = scenarios::exam_limit_ticks(s->scenario);
  s->rubric = setup.rubric_toml.empty()
                  ? s->scenario.rubric
                  : scenarios::parse_rubric(setup.rubric_toml, path + ": rubric");
  s->ground = grounds.of(*s, path);
  const auto& ground = s->ground;
  s->before = {ground, &ground->tooth};
  s->after = after_of(*ground);
  s->zones = {ground, &ground->zones};
  s->inputs = reader.inputs();
  s->records = reader.records();
  s->removed = reader.removed();
  s->events = reader.events();
  if (s->apart = ground->apart; s->apart) {
    s->own = take_apart(*s->apart, s->after.octree, s->removed);
    s->beside.emplace(AdjacentInput{*s->apart, *s->before, s->after.octree, s->removed});
  }
  s->sealed_result_json = reader.result_json();
  s->facts = {setup.candidate,
              setup.source,
              utc_text(reader.created().utc_ns),
              path,
              ground->hash,
              setup.calibration,
              setup.burs_toml,
              setup.notes};
  return s;
}

}  // namespace

std::unique_ptr<GradedSession> load_for_grading(const std::string& path) {
  ExamContexts grounds;
  return load_for_grading(path, grounds);
}

std::unique_ptr<GradedSession> load_for_grading(const std::string& path, ExamContexts& grounds) {
  return load_for_grading(SessionReader(path), grounds);
}

std::unique_ptr<GradedSession> load_for_grading(const SessionReader& reader,
                                                ExamContexts& grounds) {
  const std::string& path = reader.path();
  reader.require_readable();
  if (!reader.closed())
    throw Error(
        path, msg("this exam was not closed"),
        msg("close it as it stands with `cavum exam --resume --end --out {}`, or let it go on with --motion or --operator",
            path));
  // marks are given on evidence only: what the chain or the signature does not cover any more is
  // not graded
  if (const auto findings = check_chain(reader); !findings.empty())
    throw Error(path, msg("damaged or altered: {}", findings.front().message()),
                msg("run `cavum replay --verify` on it and use an intact copy"));
  return load_with(reader, grounds, [&](const ExamContext& ground) {
    return load_tooth_like(reader.final_tooth(), path + ": final tooth", ground.fits.get());
  });
}

std::unique_ptr<GradedSession> load_for_grading(const SessionReader& reader, Tooth after,
                                                ExamContexts& grounds) {
  return load_with(reader, grounds, [&](const ExamContext&) { return std::move(after); });
}

void use_scenario(GradedSession& session, scenarios::Scenario scenario, bool another_task) {
  if (!another_task && scenario.id != session.scenario.id)
    throw Error(
        scenario.path,
        msg("this is the task '{}', and {} was an exam in '{}'", scenario.id,
            session.facts.session_file, session.scenario.id),
        msg("name its corrected scenario, or add --another-task to mark the work by this one all the same"));
  scenarios::require_tissues(scenario, *session.before);
  scenarios::require_same_surfaces(scenario, session.scenario);
  scenario.accommodations =
      scenarios::granted(scenario.accommodations, session.session.notes,
                         msg("{}: accommodations", session.facts.session_file));
  session.zones = std::make_shared<const scenarios::ZoneMap>(scenarios::build_zones_of_exam(
      scenario, *session.before, session.session.landmarks_json, session.facts.session_file));
  session.rubric = scenario.rubric;
  session.scenario = std::move(scenario);
}

void use_rubric(GradedSession& session, scenarios::RubricSpec rubric) {
  scenarios::require_none(scenarios::not_in_this_exam(rubric, session.scenario, *session.before));
  session.rubric = std::move(rubric);
}

}  // namespace cavum::grading
