#include "tests/blind/verdict.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace cavum::blind {

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

namespace {

/// A number, or 0 where the answer has null.
double number(const nlohmann::json& object, const char* name) {
  const auto it = object.find(name);
  return it != object.end() && it->is_number() ? it->get<double>() : 0.0;
}

std::vector<std::string> texts(const nlohmann::json& list) {
  std::vector<std::string> out;
  for (const auto& item : list)
    out.push_back(item.is_string() ? item.get<std::string>() : item.dump());
  return out;
}

void read(const nlohmann::json& j, Verdict& v) {
  if (j.contains("error")) {
    v.verdict = j.at("error").at("code").get<std::string>();
    v.data_faults = {j.at("error").at("what").get<std::string>()};
    return;
  }
  v.verdict = j.at("verdict").get<std::string>();
  for (const auto& c : j.at("causes")) {
    Cause cause{c.at("mechanism").get<std::string>(), texts(c.at("aliases")), {}};
    for (const auto& [name, p] : c.at("parameters").items())
      cause.parameters[name] = {number(p, "value"), number(p, "low"), number(p, "high")};
    v.causes.push_back(std::move(cause));
  }
  if (!j.at("unexplained").is_null())
    v.unexplained = j.at("unexplained").at("variable").get<std::string>();
  v.not_testable = texts(j.at("not_testable"));
  for (const auto& fault : j.at("data_faults"))
    v.data_faults.push_back(fault.at("text").get<std::string>());
  if (j.at("base").is_object()) v.base_rmse_n = number(j.at("base"), "heldout_rmse_n");
  if (j.at("extended").is_object()) v.extended_rmse_n = number(j.at("extended"), "heldout_rmse_n");
  if (j.at("gain").is_object()) v.gain_percent = number(j.at("gain"), "percent");
  v.next_experiment = j.at("next_experiment").value("kind", "");
}

}  // namespace

bool Cause::holds(const std::string& name) const {
  return aliases.size() <= 2 &&
         (mechanism == name || std::find(aliases.begin(), aliases.end(), name) != aliases.end());
}

Verdict ask(const std::filesystem::path& cavum, const std::filesystem::path& folder,
            std::uint64_t seed, const std::string& options) {
  Verdict v;
  const auto begin = std::chrono::steady_clock::now();
  const std::string command =
      "'" + cavum.string() + "' explain '" + (folder / "recording.csv").string() +
      "' --json --seed " + std::to_string(seed) + " " + options + " > '" +
      (folder / "answer.json").string() + "' 2> '" + (folder / "errors.txt").string() + "'";
  const int status = std::system(command.c_str());
  v.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  try {
    read(nlohmann::json::parse(text_of(folder / "answer.json")), v);
    v.answered = true;
  } catch (const std::exception& e) {
    std::string errors = text_of(folder / "errors.txt");
    v.trouble =
        "status " + std::to_string(status) + ": " + errors.substr(0, 300) + " (" + e.what() + ")";
  }
  return v;
}

}  // namespace cavum::blind
