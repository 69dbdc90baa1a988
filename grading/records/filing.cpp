#include "grading/records/filing.h"

#include <fmt/core.h>

#include <filesystem>

#include "engine/base/file.h"
#include "engine/base/json_fields.h"
#include "engine/base/text.h"
#include "engine/session/session_image.h"
#include "grading/marking/grade.h"
#include "grading/marking/school_mark.h"
#include "scenarios/file/parse.h"

namespace cavum::records {
namespace {

constexpr std::int64_t k_longest_refused_ticks = 600'000;  // 10 minutes, simulated in some 3 s

std::string scenario_id_of(const SessionSetup& setup, const grading::SchoolMark& mark) {
  if (mark.result.is_object()) return text_in(member_of(mark.result, "scenario"), "id");
  try {
    return scenarios::parse_scenario(setup.scenario_toml, "scenario.toml").id;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    return "";  // a damaged session filed for an appeal
  }
}

/// The entry, as far as the recording and its mark give it.
SessionEntry entry_of(const SessionReader& session, const SessionSetup& setup,
                      const grading::SchoolMark& mark, const std::string& file_sha256) {
  SessionEntry e;
  e.candidate = one_line(setup.candidate);
  e.scenario_id = scenario_id_of(setup, mark);
  e.file_sha256 = file_sha256;
  e.chain_sha256 = to_hex(session.seal()->chain_sha256);
  e.station_key = mark.replay.station_key;
  e.nonce = ticket_nonce_in(setup);
  e.source = {setup.source.kind, one_line(setup.source.name), one_line(setup.source.serial)};
  e.simulated = one_line(simulated_by(session, setup));
  e.begun_utc_ns = session.created().utc_ns;
  e.closed_utc_ns = session.seal()->clocks.utc_ns;
  e.ticks = mark.replay.ticks;
  e.grading_version = grading::k_grading_version;
  e.physics_version = session.number("physics_version", 0);
  e.result = make_opening(mark.result);
  if (!mark.sealed_otherwise.is_null()) e.sealed = make_opening(session.result_json());
  return e;
}

/// Throws Error when it cannot be filed at all.
void require_closed(const SessionReader& session) {
  const std::string& path = session.path();
  if (!session.closed() && !session.findings().empty())
    throw Error(path, msg("is damaged: {}", session.findings().front().message()),
                msg("use an intact copy"));
  if (!session.closed())
    throw Error(
        path, msg("was never closed"),
        msg("resume the exam, or close it as it stands: `cavum exam --resume --end --out {}`",
            path));
}

Bytes image_of(const std::string& path, Findings& findings) {
  Damages left_out;
  Bytes image = read_session_image(path, left_out);
  append(findings, left_out);
  return image;
}

auto claims_of(Ledger& ledger, const SessionReader& session, const FilingOptions& options) {
  return [&](const LedgerContent& c) {
    return check_claims(c, ledger.registry(), session, read_clocks().utc_ns, options,
                        &ledger.places());
  };
}

/// Takes the marked image in: `out` holds the findings of reading it, `claimed` what the ledger has
/// against it.
void enter(Ledger& ledger, const Bytes& image, const SessionReader& session,
           const grading::SchoolMark& mark, const FilingOptions& options, const Findings& claimed,
           std::size_t seen, Filing& out) {
  const SessionSetup setup = session.setup();
  const std::string file_sha256 = to_hex(sha256(image));
  const auto claims = claims_of(ledger, session, options);
  const auto refused = [&] { return !out.findings.empty() && !options.with_findings; };
  append(out.findings, mark.findings());
  append(out.findings, claimed);
  if (refused()) return;

  const std::string kept = ledger.places().session(file_sha256);
  make_private_folder(ledger.places().folder + "/sessions");
  write_private_file(kept, image);
  if (read_file(kept) != image)
    throw DatabaseError(kept, msg("does not hold what was written"),
                        msg("check the disk, and file the exam again"), DiskRefusal{});
  SessionEntry entry = entry_of(session, setup, mark, file_sha256);
  const std::size_t entered =
      ledger.append_all([&](const LedgerContent& now) -> std::vector<Entry> {
        // again under the lock: somebody may have used the ticket meanwhile
        auto late = now.entries.size() == seen ? Findings() : claims(now);
        if (!late.empty() && out.findings.empty()) out.findings = std::move(late);
        if (refused()) return {};
        entry.findings = out.findings;
        return {std::move(entry)};
      });
  if (entered > 0) out.seq = ledger.content().entries.back().seq;
}

SessionReader require_closed_session(const Bytes& image, const std::string& path) {
  SessionReader session(image, path);
  require_closed(session);
  return session;
}

}  // namespace

Filing file_session(Ledger& ledger, const std::string& path, const FilingOptions& options,
                    grading::ExamContexts& grounds) {
  Filing out;
  ledger.refresh();
  const Bytes image = image_of(path, out.findings);
  const SessionReader session = require_closed_session(image, path);
  const std::size_t seen = ledger.content().entries.size();
  auto claimed = claims_of(ledger, session, options)(ledger.content());
  if (session.ticks() > k_longest_refused_ticks && !claimed.empty() &&
      !options.with_findings) {  // a stranger's file is not worth minutes of work
    out.findings = std::move(claimed);
    out.findings.push_back(finding<FindingKind::not_simulated_long>(
        as_number(static_cast<double>(session.ticks()) * k_tick_s / 60.0, 0)));
    return out;
  }
  enter(ledger, image, session, grading::mark_again(session, grounds), options, claimed, seen, out);
  return out;
}

MarkedRecording::MarkedRecording(const std::string& path, grading::ExamContexts& grounds)
    : image_(image_of(path, findings_)),
      session_(require_closed_session(image_, path)),
      mark_(grading::mark_again(session_, grounds)) {}

Filing file_session(Ledger& ledger, const MarkedRecording& marked, const FilingOptions& options) {
  Filing out;
  ledger.refresh();
  out.findings = marked.findings_;
  const auto claimed = claims_of(ledger, marked.session_, options)(ledger.content());
  enter(ledger, marked.image_, marked.session_, marked.mark_, options, claimed,
        ledger.content().entries.size(), out);
  return out;
}

}  // namespace cavum::records
