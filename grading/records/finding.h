// What is found wrong with a ledger, or with a recording, receipt, note or backup that is held against it: a kind, which programs ask for, and the
// sentence. What could not be checked is of the kind of trouble that it might have shown.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "engine/base/message.h"
#include "engine/base/named_enum.h"

namespace cavum {
struct JsonPlace;
}
namespace cavum::grading {
struct SchoolMark;
}

namespace cavum::records {

// clang-format off
#define CAVUM_LEDGER_FINDINGS(KIND) \
  /* a recording */ \
  KIND(recording_unsound)      /* damaged, or its motion does not give what it holds */ \
  KIND(not_closed) \
  KIND(not_simulated) \
  KIND(exam_differs)           /* scenario, servo or events are not those of the motion and the exam */ \
  KIND(result_differs)         /* from what marking gives */ \
  KIND(text_unclean)           /* of a name: control characters, no UTF-8 */ \
  KIND(submitted_twice) \
  KIND(no_hand)                /* something else moved the stylus */ \
  KIND(device_other)           /* a stylus that the station was not enrolled with, or another one after a gap */ \
  KIND(clock)                  /* times that contradict one another or the ledger's */ \
  KIND(handed_in_late) \
  KIND(pause_unknown)          /* of which the office knows nothing */ \
  KIND(self_check)             /* of the stylus, before the exam */ \
  KIND(station_changed)        /* taken up or ended by another than began it, or by one that does not remember it */ \
  KIND(station_unknown)        /* or none is named */ \
  KIND(station_revoked) \
  KIND(station_run_out) \
  /* its ticket, and the ledger's word to begin */ \
  KIND(ticket_missing) \
  KIND(ticket_invalid) \
  KIND(ticket_other_school) \
  KIND(ticket_unknown)         /* to this ledger */ \
  KIND(ticket_cancelled) \
  KIND(ticket_made_up)         /* by a makeup sitting */ \
  KIND(ticket_used) \
  KIND(ticket_candidate) \
  KIND(ticket_scenario)        /* or rubric, or an attachment of it */ \
  KIND(ticket_tooth) \
  KIND(ticket_model) \
  KIND(ticket_bur) \
  KIND(ticket_accommodations) \
  KIND(ticket_time) \
  KIND(begin_missing) \
  KIND(begin_invalid)          /* of another exam, never given, or not the last one */ \
  /* files */ \
  KIND(file_gone) \
  KIND(file_changed) \
  KIND(file_unreadable) \
  KIND(malformed)              /* a receipt, note, cosignature or export that is none */ \
  KIND(foreign)                /* belongs to no entry */ \
  KIND(erased_still_there) \
  KIND(identities_changed) \
  KIND(identity_missing) \
  /* entries, tree, signatures */ \
  KIND(schema_differs) \
  KIND(no_beginning) \
  KIND(entry_missing) \
  KIND(entry_changed) \
  KIND(entry_malformed) \
  KIND(entry_out_of_order) \
  KIND(entry_contradicts)      /* those before it */ \
  KIND(part_missing)           /* an opening or document that an entry names */ \
  KIND(part_changed) \
  KIND(checkpoint_missing) \
  KIND(tree_differs)           /* from what was signed */ \
  KIND(signature_invalid)      /* the school's */ \
  KIND(cosignature_invalid) \
  KIND(cosignature_unknown)    /* nobody's that is known here */ \
  KIND(other_school) \
  KIND(other_ledger) \
  KIND(key_run_out) \
  KIND(key_unreadable) \
  KIND(key_half_replaced) \
  KIND(older_copy)             /* was put back */ \
  KIND(rewritten)              /* history was */ \
  KIND(witness_changed) \
  /* what is proved of a recording */ \
  KIND(unchanged)              /* since it was signed, or recorded */ \
  KIND(motion_gives_forces)    /* forces, removed leaves and tooth again */ \
  KIND(motion_gives_events)    /* events again, and the result where it is sealed by the same rules */ \
  KIND(closed_by) \
  KIND(promised)               /* by the school's ticket */ \
  /* of remarks */ \
  KIND(school_not_compared)    /* whose key signed the ticket */ \
  KIND(ticket_not_read) \
  KIND(no_ticket) \
  KIND(tried_to_leave)         /* a locked exam */ \
  KIND(moved)                  /* to another place while it was recorded */ \
  KIND(log_beside) \
  KIND(station_not_known)      /* whose it is, is known to the ledger only */ \
  KIND(hand_not_shown)         /* by any file */ \
  KIND(earlier_end_not_shown) \
  KIND(other_exam_not_shown)   /* with the same ticket */ \
  KIND(clock_set_back)         /* the ledger's own */ \
  KIND(clock_ahead) \
  KIND(restored)               /* went on from a backup, and what was lost by that */ \
  KIND(contested)              /* by another ending of the same exam */ \
  KIND(release_void)
// clang-format on

CAVUM_NAMED_ENUM(FindingKind, CAVUM_LEDGER_FINDINGS)

struct Finding {
  FindingKind kind{};
  Message what;
  std::optional<std::uint64_t> entry = {};  ///< of the ledger that is checked, where it is about one
  friend bool operator==(const Finding&, const Finding&) = default;
};
using Findings = std::vector<Finding>;

/// Of this kind, each: what others say in words alone.
[[nodiscard]] Findings findings_of(FindingKind kind, const std::vector<Message>& messages);
[[nodiscard]] Findings findings_of(const grading::SchoolMark& mark);
[[nodiscard]] std::vector<Message> words_of(const Findings& findings);
/// With `before` before each: "receipt.json: ...".
[[nodiscard]] Findings named(const Message& before, Findings findings);
void append(Findings& to, const Findings& more);

/// For other programs: {"kind", "values", "text", "entry"}.
void to_json(nlohmann::json& json, const Finding& finding);
// As our own files keep it: {"kind", "say", "of"}.
[[nodiscard]] nlohmann::json write_json(const Finding& finding);
void read_json(const nlohmann::json& from, const JsonPlace& at, Finding& finding);

}  // namespace cavum::records
