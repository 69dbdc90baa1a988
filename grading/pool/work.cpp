#include "grading/pool/work.h"

#include <nlohmann/json.hpp>

#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/message_json.h"
#include "engine/base/text.h"
#include "engine/base/version.h"
#include "engine/physics/servo/servo.h"
#include "engine/session/session_image.h"
#include "grading/marking/grade.h"
#include "grading/marking/school_mark.h"
#include "grading/marking/session_input.h"
#include "grading/result/result_json.h"
#include "scenarios/file/parse.h"

namespace cavum::pool {
namespace {

using nlohmann::json;

constexpr const char* k_what[] = {"verify", "mark", "regrade"};
constexpr JsonLimits k_work_limits{1U << 30, 20'000'000, 8};

std::string dumped(const json& j) { return j.dump(-1, ' ', false, json::error_handler_t::replace); }

/// An error speaks of the file without its folder, which is another one on each machine.
Bytes image_below(const std::string& folder, const std::string& name, Damages& findings) {
  try {
    return read_session_image(folder.empty() ? name : folder + "/" + name, findings);
  } catch (const Error& e) {
    throw Error(e.code(), Name{name}, e.problem(), e.advice());
  }
}

/// The session marked as the work asks.
json marked(const Work& work, const SessionReader& session, grading::ExamContexts& grounds) {
  const auto graded = grading::load_for_grading(session, grounds);
  if (!work.scenario_toml.empty()) {
    auto scenario = scenarios::parse_scenario(work.scenario_toml, "scenario.toml");
    scenarios::use_surfaces(scenario, work.surfaces);
    grading::use_scenario(*graded, std::move(scenario), work.another_task);
    grading::use_rubric(*graded, graded->scenario.rubric);
  }
  if (!work.rubric_toml.empty())
    grading::use_rubric(*graded, scenarios::parse_rubric(work.rubric_toml, "rubric.toml"));
  return parse_json(grading::to_json(grading::grade(graded->input(), graded->rubric)).dump(),
                    msg("result"));
}

}  // namespace

std::string to_text(const Work& work) {
  json surfaces = json::array();
  for (const auto& [name, bytes] : work.surfaces)
    surfaces.push_back({{"name", name}, {"hex", to_hex(bytes)}});
  return dumped({{"cavum", version()},
                 {"physics", k_physics_version},
                 {"grading", grading::k_grading_version},
                 {"what", k_what[static_cast<int>(work.what)]},
                 {"sessions", work.sessions},
                 {"rubric", work.rubric_toml},
                 {"scenario", work.scenario_toml},
                 {"surfaces", surfaces},
                 {"another_task", work.another_task}});
}

Work parse_work(const std::string& text, const std::string& where) {
  const json j = parse_json(text, where, k_work_limits);
  if (text_in(j, "cavum") != version() || whole_in(j, "physics") != k_physics_version ||
      whole_in(j, "grading") != grading::k_grading_version)
    throw Error(where, msg("was made by another version of the program"),
                msg("run the same version on all machines"));
  Work work;
  const std::string what = text_in(j, "what");
  bool known = false;
  for (int i = 0; i < 3; ++i)
    if (what == k_what[i]) work.what = static_cast<What>(i), known = true;
  const json &sessions = member_of(j, "sessions"), &surfaces = member_of(j, "surfaces"),
             &another = member_of(j, "another_task");
  if (!known || !sessions.is_array() || !surfaces.is_array() || !another.is_boolean())
    throw Error(where, msg("is no list of work"), msg("make it anew, by `cavum verify-all`"));
  for (const auto& s : sessions) {
    if (!s.is_string())
      throw Error(where, msg("names a session that is no text"), msg("make the work anew"));
    work.sessions.push_back(s.get<std::string>());
  }
  work.rubric_toml = text_in(j, "rubric");
  work.scenario_toml = text_in(j, "scenario");
  for (const auto& s : surfaces) {
    auto bytes = from_hex(text_in(s, "hex"));
    if (!bytes)
      throw Error(where, msg("holds a surface that is not hexadecimal"), msg("make the work anew"));
    work.surfaces.emplace_back(text_in(s, "name"), std::move(*bytes));
  }
  work.another_task = another.get<bool>();
  return work;
}

std::string id_of(const Work& work) { return to_hex(sha256(to_text(work))); }

std::string line_of(const Work& work, std::size_t index, grading::ExamContexts& grounds) {
  const std::string& name = work.sessions[index];
  json line{{"session", name}};
  const auto failed = [&line](const Message& error) {
    line["error"] = one_line(english_text(error));
    line["message"] = encode(error);
  };
  try {
    Damages findings;
    const Bytes image = image_below(work.folder, name, findings);
    line["sha256"] = to_hex(sha256(image));
    const SessionReader session(image, name);
    if (work.what == What::verify) {
      const grading::SchoolMark mark = grading::mark_again(session, grounds);
      for (auto& f : mark.findings()) findings.push_back(std::move(f));
      line["verified"] = mark.holds() && findings.empty();
      line["ticks"] = mark.replay.ticks;
      line["findings"] = findings;
      line["result"] = mark.result;
    } else {
      line["result"] = marked(work, session, grounds);
      line["ticks"] = session.ticks();
    }
  } catch (const std::bad_alloc&) {
    throw;  // nothing is wrong with the session
  } catch (const Error& e) {
    failed(e.where_and_problem());
  } catch (const std::exception& e) {
    failed(Name{e.what()});
  }
  return dumped(line);
}

Message error_in(const json& line) {
  return line.contains("error") ? decode_message(member_of(line, "message")) : Message();
}

Damages findings_in(const json& line) {
  Damages all;
  for (const json& f : member_of(line, "findings")) all.push_back(decode_fact<DamageKind>(f));
  return all;
}

}  // namespace cavum::pool
