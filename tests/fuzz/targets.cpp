#include "tests/fuzz/targets.h"

namespace cavum::fuzz {

const std::vector<Target>& targets() {
  static const std::vector<Target> k_all {
    {"session", fuzz_session, session_seeds}, {"recording", fuzz_recording, recording_seeds},
        {"replay", fuzz_replay, replay_seeds}, {"settings", fuzz_settings, settings_seeds},
        {"ticket", fuzz_ticket, ticket_seeds}, {"receipt", fuzz_receipt, receipt_seeds},
        {"candidates", fuzz_candidates, candidates_seeds}, {"marks", fuzz_marks, marks_seeds},
        {"scenario", fuzz_scenario, scenario_seeds}, {"motion", fuzz_motion, motion_seeds},
        {"tooth", fuzz_tooth, tooth_seeds}, {"mesh", fuzz_mesh, mesh_seeds},
        {"explain", fuzz_explain, explain_seeds}, {"results", fuzz_results, results_seeds},
        {"notes", fuzz_notes, notes_seeds}, {"entries", fuzz_entries, entries_seeds},
        {"ledger", fuzz_ledger, ledger_seeds},
#if defined(CAVUM_FUZZ_OFFICE)
        {"office", fuzz_office, office_seeds},
#endif
#if defined(CAVUM_FUZZ_VOLUMES)
        {"volume", fuzz_volume, volume_seeds},
#endif
  };
  return k_all;
}

}  // namespace cavum::fuzz
