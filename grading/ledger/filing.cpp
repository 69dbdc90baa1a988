#include "grading/ledger/filing.h"

#include <filesystem>

#include "engine/base/file.h"
#include "engine/base/json_reader.h"
#include "engine/session/verify.h"
#include "scenarios/parse.h"

namespace cavum {

using nlohmann::json;

Filing file_session(Ledger& ledger, const std::string& path, const FilingOptions& options) {
  Filing out;
  ledger.refresh();
  const VerifyReport report = verify_session(path);
  const SessionReader session(path);
  if (!report.closed)
    throw Error(path, "was never closed", "resume the exam, or close it as it stands: `cavum exam --resume --end --out " + path + "`");
  out.findings = report.findings;
  const Bytes bytes = read_file(path);
  const SessionSetup setup = session.setup();
  const std::string file_sha256 = to_hex(sha256(bytes)), chain = to_hex(session.seal()->chain_sha256), nonce = ticket_nonce_in(setup);
  const std::int64_t begun = session.created().utc_ns;

  const auto refused = [&] { return !out.findings.empty() && !options.with_findings; };
  const auto claims = [&](const LedgerContent& c) { return check_claims(c, session, options, &ledger.places()); };
  for (auto& f : claims(ledger.content())) out.findings.push_back(std::move(f));
  if (refused()) return out;

  std::filesystem::create_directories(ledger.places().folder + "/sessions");
  write_file(ledger.places().session(file_sha256), bytes);
  std::string scenario_id;
  try {
    scenario_id = parse_scenario(setup.scenario_toml, "scenario.toml").id;
  } catch (const std::exception&) {
    scenario_id = "";  // a damaged session filed for an appeal
  }
  struct Refused {};
  try {
    out.seq = ledger
                  .append("session",
                          [&](const LedgerContent& now) -> json {
                            // again under the lock: somebody may have used the ticket meanwhile
                            auto late = claims(now);
                            if (!late.empty() && out.findings.empty()) out.findings = std::move(late);
                            if (refused()) throw Refused();
                            json result = parse_json_or_null(session.result_json(), k_json_part);
                            return {{"candidate", setup.candidate},
                                    {"chain_sha256", chain},
                                    {"file_sha256", file_sha256},
                                    {"findings", out.findings},
                                    {"begun_utc_ns", begun},
                                    {"closed_utc_ns", session.seal()->clocks.utc_ns},
                                    {"nonce", nonce},
                                    {"simulated", simulated_by(session, setup)},
                                    {"result", is_result(result) ? result : json(nullptr)},
                                    {"scenario_id", scenario_id},
                                    {"station_key", report.station_key},
                                    {"ticks", report.ticks}};
                          })
                  .seq;
  } catch (const Refused&) {
    return out;
  }
  return out;
}

}  // namespace cavum
