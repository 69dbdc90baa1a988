#include "engine/session/resume.h"

#include "engine/session/chain.h"
#include "engine/session/chain_check.h"
#include "engine/session/session_error.h"

namespace cavum {

/// The recorder's door for resuming: puts it where the file ends.
class Resumption {
 public:
  static Recorder open(const SessionReader& session, const ReadClocks& clocks) {
    Recorder recorder(session.path(), load_station_key(station_key_path()), clocks);
    recorder.open_for_recording();
    recorder.chain_ = session.chunks().empty() ? genesis_hash(session.meta(), session.artifacts())
                                               : session.chunks().back().sha256;
    recorder.next_chunk_ = static_cast<std::int64_t>(session.chunks().size());
    recorder.next_event_ = static_cast<std::int64_t>(session.event_rows().size());
    recorder.next_artifact_ = static_cast<std::int64_t>(session.artifacts().size());
    recorder.ticks_ = recorder.ticks_on_disk_ = session.ticks();
    recorder.pending_.back().state_hash =
        session.chunks().empty() ? 0 : session.chunks().back().state_hash;
    // Nobody may have written between reading and opening; the lock is ours from the first read on.
    if (recorder.database_->integer("SELECT count(*) FROM chunk") != recorder.next_chunk_ ||
        recorder.database_->integer("SELECT count(*) FROM seal") != 0)
      throw Error(session.path(), msg("was written to while it was being resumed"),
                  msg("try again"));
    return recorder;
  }
  static std::string station_of(const Recorder& recorder) {
    return to_hex(recorder.key_.public_key);
  }
};

namespace {

void require_intact(const SessionReader& session) {
  session.require_readable();
  if (session.closed())
    throw Error(SessionError::closed, Name{session.path()}, msg("is closed"),
                msg("there is nothing to resume: start a new exam"));
  const auto findings = check_chain(session);
  if (!findings.empty())
    throw Error(session.path(), findings.front().message(),
                msg("it is evidence now: keep it, and start a new exam"));
}

void simulate(const SessionReader& session, Simulation& simulation, const TickVisitor& visit) {
  for (std::size_t i = 0; i < session.chunks().size(); ++i) {
    const ChunkRow& c = session.chunks()[i];
    const ChunkMotion motion = session.motion(i);
    for (std::size_t t = 0; t < motion.inputs.size(); ++t) {
      const TickOutput output = step(simulation.model, simulation.state, motion.inputs[t]);
      if (visit)
        visit(c.first_tick + static_cast<std::int64_t>(t), motion.inputs[t], output,
              simulation.state);
    }
    if (c.ticks > 0 && state_hash(simulation.state) != c.state_hash)
      throw Error(session.path(), msg("replays differently by tick {}", c.first_tick + c.ticks),
                  msg("run `cavum replay --verify` on it"));
  }
}

RecordingGap gap_of(const SessionReader& session, const ResumedBy& by,
                    const std::string& station_key, const Clocks& now) {
  const Clocks last = session.chunks().empty() ? session.created() : session.chunks().back().clocks;
  std::string last_boot = session.fact("boot_id");
  for (const auto& e : session.event_rows())
    if (const auto* gap = e.as<RecordingGap>(); gap != nullptr && !gap->boot_id.empty())
      last_boot = gap->boot_id;
  RecordingGap gap{last.utc_ns, now.utc_ns, {}, boot_id(), station_key, by};
  if (!gap.boot_id.empty() && gap.boot_id == last_boot)
    gap.boot_s = static_cast<double>(now.boot_ns - last.boot_ns) * 1e-9;
  return gap;
}

}  // namespace

ResumedSession resume_session(const std::string& path, const TickVisitor& visit,
                              const ResumedBy& by, const ReadClocks& clocks) {
  const SessionReader session(path);
  require_intact(session);
  SessionSetup setup = session.setup();
  Simulation simulation = make_simulation(setup, path);
  simulate(session, simulation, visit);
  Recorder recorder = Resumption::open(session, clocks);
  recorder.add_event(session.ticks(),
                     gap_of(session, by, Resumption::station_of(recorder), clocks()));
  try {
    recorder.flush();
  } catch (const DatabaseError&) {  // a full disk: the gap waits in memory, and is written before
                                    // anything that comes
  }
  return {std::move(recorder), std::move(simulation), std::move(setup), session.ticks()};
}

}  // namespace cavum
