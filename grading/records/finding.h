// What is found wrong with a ledger, or with a recording, receipt, note or backup that is held
// against it; what is proved of a recording; and what else is to be known. What could not be
// checked is of the group of the trouble that it might have shown. One table has all kinds.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "engine/session/damage.h"

namespace cavum {
struct JsonLocation;
}

namespace cavum::records {

// KIND(kind, group, English sentence, names of its values); `why` is what an error said. The
// damages of a recording stand first.
// clang-format off
#define CAVUM_LEDGER_FINDINGS(KIND) \
  CAVUM_DAMAGES(KIND) \
  /* a recording */ \
  KIND(no_hand, no_hand, "no candidate's hand moved this exam, but '{}' (--simulated files it as that)", "by") \
  KIND(device_other, device_other, "the stylus {} (serial number '{}') is none that the station was enrolled with", "stylus", "serial") \
  KIND(device_changed, device_other, "the exam was begun with {}, and taken up again with {}", "begun_with", "resumed_with") \
  KIND(text_unclean, text_unclean, "the candidate's name holds a control character or bytes that are no UTF-8: '{}'", "text") \
  KIND(source_unclean, text_unclean, "the name of the source of motion holds a control character or bytes that are no UTF-8: '{}'", "text") \
  KIND(serial_unclean, text_unclean, "the serial number of the source of motion holds a control character or bytes that are no UTF-8: '{}'", "text") \
  KIND(submitted_twice, submitted_twice, "this session was submitted before: entry {}", "before") \
  KIND(ended_after_filing, clock, "by the station's clock the exam ended on {}, after it was handed in", "ended") \
  KIND(ended_before_begin, clock, "by the station's clock the exam ended on {}, before it began", "ended") \
  KIND(begun_before_issue, clock, "by the station's clock the exam began on {}, before its ticket was issued", "begun") \
  KIND(begun_before_let, clock, "by the station's clock the exam began on {}, and the ledger let it begin on {}: the station's clock was set back", "begun", "let_begin") \
  KIND(handed_in_late, handed_in_late, "it was handed in on {}, more than a day after its ticket's time and after it ended by the station's clock ({}): nothing but that clock shows when it was sat", "handed_in", "ended") \
  KIND(pause_unknown, pause_unknown, "its clock was held for the office from {} to {}, and the ledger knows of no such pause", "begun", "ended") \
  KIND(self_check, self_check, "{}", "what") \
  KIND(station_unknown, station_unknown, "the station with the key {} is not enrolled: anybody can make such a recording", "station") \
  KIND(station_unnamed, station_unknown, "the recording names no station's key: anybody can make such a recording", ) \
  KIND(beginning_unsigned, station_unknown, "the recording does not say which station began it, and bears no signature of its beginning", ) \
  KIND(station_revoked, station_revoked, "the key of station '{}' was revoked on {}", "station", "utc") \
  KIND(station_replaced, station_revoked, "the key of station '{}' was replaced, and good until {}", "station", "utc") \
  KIND(station_run_out, station_run_out, "the key of station '{}' ran out on {}", "station", "utc") \
  /* its ticket, and the ledger's word to begin */ \
  KIND(ticket_missing, ticket_missing, "the session holds no ticket: nobody promised this exam", ) \
  KIND(ticket_of_pseudonym, ticket_missing, "the session bears a pseudonym, and no ticket that it was given by", ) \
  KIND(ticket_invalid, ticket_invalid, "{}", "why") \
  KIND(ticket_other_school, ticket_other_school, "the session's ticket is the ticket of another school", ) \
  KIND(ticket_unknown, ticket_unknown, "the ledger has not issued this ticket", ) \
  KIND(ticket_other_ledger, ticket_unknown, "the ticket was issued by another ledger", ) \
  KIND(ticket_cancelled, ticket_cancelled, "its ticket was cancelled on {} (entry {})", "utc", "by") \
  KIND(ticket_made_up, ticket_made_up, "a makeup sitting was given in its place (entry {})", "by") \
  KIND(ticket_used, ticket_used, "the ticket was used before: entry {}", "by") \
  KIND(ticket_used_recording, ticket_used, "the ticket was used before: entry {} holds another recording", "by") \
  KIND(ticket_used_ending, ticket_used, "the ticket was used before: entry {} holds another ending of the same recording: both are the same up to tick {}; that one ends at tick {}, this one at tick {}", "by", "same_ticks", "by_ticks", "ticks") \
  KIND(ticket_used_unread, ticket_used, "the ticket was used before: entry {}, whose file cannot be compared: {}", "by", "why") \
  KIND(ticket_candidate, ticket_candidate, "the ticket is candidate {}'s, the exam was sat by {}", "promised", "candidate") \
  KIND(ticket_artifact, ticket_artifact, "{} is not the one that the ticket promises", "artifact") \
  KIND(ticket_artifact_missing, ticket_artifact, "the ticket promises {}, which the exam does not have", "artifact") \
  KIND(ticket_artifact_added, ticket_artifact, "the exam has {}, of which the ticket says nothing", "artifact") \
  KIND(ticket_accommodations, ticket_accommodations, "the accommodations are not those that the ticket grants", ) \
  KIND(ticket_time, ticket_time, "the exam began on {}, and the ticket is good from {} to {}", "begun", "not_before", "not_after") \
  KIND(ticket_time_resumed, ticket_time, "the exam was taken up again on {}, when its ticket was no longer good", "resumed") \
  KIND(begin_missing, begin_missing, "the ledger let this exam begin on {} (entry {}), and the recording does not bear its word: it was begun without it", "utc", "begin") \
  KIND(begin_not_asked, begin_missing, "its ticket asks for the ledger's word to begin, and nobody asked the ledger", ) \
  KIND(begin_invalid, begin_invalid, "{}", "why") \
  KIND(begin_of_other, begin_invalid, "the word to begin in it is of another ledger or ticket", ) \
  KIND(begin_not_given, begin_invalid, "the ledger has not given the word to begin that is in it", ) \
  KIND(begin_not_last, begin_invalid, "it was begun with the ledger's word of {}, and the ledger let the exam begin again on {}: only the recording with the last word counts", "utc", "last_utc") \
  /* files */ \
  KIND(file_gone, file_gone, "its file is gone: {}", "path") \
  KIND(file_changed, file_changed, "its file was changed: {}", "path") \
  KIND(file_changed_meanwhile, file_changed, "its file was changed while it was checked, or a log lies beside it", ) \
  KIND(file_unreadable, file_unreadable, "its file cannot be read: {}", "why") \
  KIND(read_failed, file_unreadable, "{}", "why") \
  KIND(refusal_unreadable, file_unreadable, "why it was refused cannot be read any more", ) \
  KIND(malformed, malformed, "{}", "why") \
  KIND(no_receipt, malformed, "is no receipt, for it is not JSON text of an object: name a file that `cavum ledger add --receipts` wrote", ) \
  KIND(receipt_part, malformed, "is no receipt: a part of it is missing or of another kind than `cavum ledger add --receipts` writes", ) \
  KIND(receipt_unreadable, malformed, "is no receipt: {}", "why") \
  KIND(results_rewritten, malformed, "the text was written anew: keys, spaces or numbers are not as the school wrote them", ) \
  KIND(no_results, malformed, "are no exported results: name a file that `cavum ledger export --format json` wrote", ) \
  KIND(results_unreadable, malformed, "are no exported results: {}", "why") \
  KIND(note_changed, malformed, "checkpoint {}: its note is not as the school wrote it", "checkpoint") \
  KIND(foreign, foreign, "{}: belongs to no entry", "path") \
  KIND(opening_foreign, foreign, "opening {}: belongs to no entry; it was put into the ledger's file", "opening") \
  KIND(document_foreign, foreign, "document {}: belongs to no entry; it was put into the ledger's file", "document") \
  KIND(erased_still_there, erased_still_there, "its recording is erased by entry {}, and is still there: {}; `cavum ledger erase` without more removes it", "by", "path") \
  KIND(part_there_again, erased_still_there, "its {} was erased by entry {}, and stands there again", "part", "by") \
  KIND(forgotten_still_named, erased_still_there, "identities: {} was forgotten by entry {}, and is still named; `cavum ledger erase` without more removes it", "candidate", "by") \
  KIND(identities_changed, identities_changed, "identities: {} is not whom it was given to; the row was changed", "candidate") \
  KIND(identities_not_there, identities_changed, "whether names were exchanged among the identities, or taken out: {} is not there; restore it from its backup if this is the school's own copy", "path") \
  KIND(identities_key_missing, identities_changed, "whether names were exchanged among the identities, or taken out: the key that made the pseudonyms is not here", ) \
  KIND(identity_missing, identity_missing, "identities: {}, who has the ticket of entry {}, is missing, and no entry says that he was forgotten; restore the file from its backup", "candidate", "ticket") \
  /* simulating and marking what is filed */ \
  KIND(not_simulated, not_simulated, "could not be simulated again; run the same command once more", ) \
  KIND(not_simulated_long, not_simulated, "it lasts {} minutes, and was not simulated: of what is refused as it is at most 10 minutes are", "minutes") \
  KIND(not_simulated_unasked, not_simulated, "whether the filed sessions' motion gives their forces, teeth, events and marks again: --replay simulates and marks each", ) \
  KIND(not_simulated_unsound, not_simulated, "sessions that were filed with findings are not simulated again: {}", "sessions") \
  KIND(not_simulated_erased, not_simulated, "recordings were erased, as entries say, and whether motion gives their marks can no longer be shown: {}", "recordings") \
  KIND(filed_result_differs, result_differs, "the result that was filed is not what marking it gives: filed {}", "differences") \
  KIND(version_differs, result_differs, "was marked by grading version {}; version {} gives another result: filed {}", "grading_version", "own_version", "differences") \
  /* entries, tree, signatures */ \
  KIND(schema_differs, schema_differs, "{}: is not as this program made it; it was altered", "name") \
  KIND(schema_missing, schema_differs, "{}: was taken out of the ledger's file", "name") \
  KIND(schema_added, schema_differs, "{}: does not belong to a ledger; it was put into its file", "name") \
  KIND(no_beginning, no_beginning, "does not begin a ledger", ) \
  KIND(no_school_key, no_beginning, "names no school's public key", ) \
  KIND(entry_missing, entry_missing, "is missing", ) \
  KIND(entries_taken_out, entry_missing, "checkpoint {}: signed for {} entries, and there are {}: entries were taken out", "checkpoint", "signed", "entries") \
  KIND(entry_changed, entry_changed, "its text was changed after it was entered", ) \
  KIND(entry_malformed, entry_malformed, "is not written as this program writes entries: keys, spaces or numbers", ) \
  KIND(entry_unreadable, entry_malformed, "{}", "why") \
  KIND(entry_out_of_order, entry_out_of_order, "was entered as number {}: entries were moved", "number") \
  KIND(begins_again, entry_out_of_order, "begins a ledger a second time", ) \
  KIND(part_missing, part_missing, "its {} was taken out of the ledger", "part") \
  KIND(document_missing, part_missing, "the {} that its result was marked by was taken out of the ledger", "document") \
  KIND(part_changed, part_changed, "its {} was changed after it was entered", "part") \
  KIND(document_changed, part_changed, "document {}: was changed after it was entered", "document") \
  KIND(checkpoint_missing, checkpoint_missing, "checkpoint {}: is missing", "checkpoint") \
  KIND(checkpoint_none, checkpoint_missing, "the school has signed nothing from here on", ) \
  KIND(tree_differs, tree_differs, "checkpoint {}: an entry up to number {} is not what the school signed", "checkpoint", "last") \
  KIND(receipt_entry, tree_differs, "the entry on the receipt is not the one that the school signed", ) \
  KIND(receipt_earlier, tree_differs, "the earlier entries on the receipt are not the beginning of the later ones", ) \
  KIND(backup_changed, tree_differs, "the backup was taken of {} entries, and holds {}: it was changed since", "taken_of", "entries") \
  KIND(signature_invalid, signature_invalid, "the school's signature does not hold", ) \
  KIND(checkpoint_signature, signature_invalid, "checkpoint {}: the school's signature does not hold", "checkpoint") \
  KIND(entry_signature, signature_invalid, "{}", "why") \
  KIND(key_unsigned, signature_invalid, "names a key that the school's key before it has not signed", ) \
  KIND(receipt_signature, signature_invalid, "the school's signature on the receipt does not hold", ) \
  KIND(receipt_earlier_signature, signature_invalid, "the school's signature under the earlier entries does not hold", ) \
  KIND(results_signature, signature_invalid, "the school's signature on the results does not hold: something was changed", ) \
  KIND(results_checkpoint, signature_invalid, "the school's signature on the checkpoint does not hold", ) \
  KIND(backup_signature, signature_invalid, "the school's signature on the backup's checkpoint does not hold", ) \
  KIND(note_unsigned, signature_invalid, "the ledger's school has not signed it", ) \
  KIND(request_signature, signature_invalid, "the school's signature does not hold: the checkpoint was changed, or is signed by another key", ) \
  KIND(request_or_key, signature_invalid, "the school's signature does not hold: the checkpoint was changed, or is signed by another key; where the school replaced its key, the receipt of that entry shows it (--key-receipt)", ) \
  KIND(cosignature_invalid, cosignature_invalid, "the cosignature of {} does not hold", "cosigner") \
  KIND(cosignature_stray, cosignature_invalid, "the cosignature of {} is under a checkpoint that is not there: {}", "cosigner", "checkpoint") \
  KIND(cosignature_unknown, cosignature_unknown, "cosignatures of cosigners that are not known here: {}; put their key lines into {}", "cosignatures", "path") \
  KIND(cosignature_none, cosignature_unknown, "whether anybody cosigned it: it bears no cosignature of a cosigner that is known here", ) \
  KIND(other_school, other_school, "the ledger is of another school than {} names: signed by {}, expected {}", "path", "signed_by", "expected") \
  KIND(school_unread, other_school, "whether the ledger is this school's, and whether names were exchanged among the identities, or taken out: the ledger's id and key could not be read, so nothing could be compared", ) \
  KIND(school_not_named, other_school, "whether the ledger is this school's: neither {} nor {} is here to compare with", "key_path", "public_key_path") \
  KIND(receipt_other_school, other_school, "the receipt is of another school's key", ) \
  KIND(results_other_school, other_school, "the results are signed by another school's key", ) \
  KIND(results_other_key, other_school, "the results are signed by a key that was not the school's at that time", ) \
  KIND(other_ledger, other_ledger, "{} is of another ledger", "what") \
  KIND(key_run_out, key_run_out, "was entered on {}, and the school's key had run out on {}", "utc", "until") \
  KIND(key_unreadable, key_unreadable, "{}: is no school's public key, 64 hexadecimal digits; copy it again from the school's computer", "path") \
  KIND(key_unusable, key_unreadable, "the school's key cannot be used: {}", "why") \
  KIND(key_half_replaced, key_half_replaced, "replacing the school's key was cut off: {} is still there; `cavum ledger key LEDGER --replace` goes on with it", "path") \
  KIND(older_copy, older_copy, "the ledger was put back to an older copy: it has {} entries, {} saw {}", "entries", "what", "seen") \
  KIND(older_than_witness, older_copy, "the ledger was put back to an older copy: it has {} entries, and had {} on {}", "entries", "seen", "utc") \
  KIND(older_than_cosigned, older_copy, "the ledger was put back to an older copy, or this is an older file: entries in it: {}, cosigned: {}; keep this file and {}: both bear the school's signature", "entries", "cosigned", "path") \
  KIND(older_unread, older_copy, "whether an older copy was put back, and which of the filed sessions belong to it: the ledger's id could not be read, so nothing could be compared", ) \
  KIND(older_no_witness, older_copy, "whether an older copy was put back: this computer has no witness of the ledger", ) \
  KIND(rewritten, rewritten, "the ledger no longer begins with what {} saw: history was rewritten", "what") \
  KIND(rewritten_witness, rewritten, "the ledger's first {} entries are not those of {}: history was rewritten", "entries", "utc") \
  KIND(rewritten_cosigned, rewritten, "the ledger has other entries than those that were cosigned: history was rewritten; keep this file and {}: both bear the school's signature", "path") \
  KIND(rewritten_proof, rewritten, "the proof does not lead from the entries that were cosigned ({}) to these: history was rewritten, or the file was damaged; keep this file and {}: both bear the school's signature", "cosigned", "path") \
  KIND(witness_changed, witness_changed, "{}: the witness was changed at entry {}", "path", "at") \
  KIND(witness_or_older, witness_changed, "{}: the witness was changed at entry {}, or an older copy of the ledger was put back, from before the school's key was replaced", "path", "at") \
  /* an entry that contradicts those before it */ \
  KIND(entry_contradicts, entry_contradicts, "{}", "why") \
  KIND(entry_unknown, entry_contradicts, "speaks of an entry that is not there", ) \
  KIND(ticket_number_taken, entry_contradicts, "a ticket with a number that another one has", ) \
  KIND(seat_unknown, entry_contradicts, "seats a candidate at a station that is not enrolled", ) \
  KIND(cancels_void, entry_contradicts, "cancels a ticket that was used or cancelled before", ) \
  KIND(begins_otherwise, entry_contradicts, "lets an exam begin at another time than it was entered", ) \
  KIND(begins_other_ledger, entry_contradicts, "lets an exam of another ledger begin", ) \
  KIND(releases_void, entry_contradicts, "releases a result that does not count", ) \
  KIND(retracts_void, entry_contradicts, "takes back a result that is not released", ) \
  KIND(appeal_beside, entry_contradicts, "an appeal beside one that is open", ) \
  KIND(answers_void, entry_contradicts, "answers an appeal that is not open", ) \
  KIND(sends_void, entry_contradicts, "sends a result that is not the session's", ) \
  KIND(makes_up_other, entry_contradicts, "makes up another candidate's ticket, or one of another exam", ) \
  KIND(makes_up_twice, entry_contradicts, "makes up a ticket that another one makes up", ) \
  KIND(makes_up_released, entry_contradicts, "makes up a sitting whose result is released", ) \
  KIND(erases_void, entry_contradicts, "erases what is not there: '{}' of entry {}", "part", "of") \
  KIND(entered_ticket_unknown, ticket_unknown, "a session with a ticket that was not issued", ) \
  KIND(entered_ticket_cancelled, ticket_cancelled, "a ticket that was cancelled by entry {}", "by") \
  KIND(entered_ticket_made_up, ticket_made_up, "a ticket that entry {} makes up", "by") \
  /* what is proved of a recording */ \
  KIND(unchanged, unchanged, "nothing in the file was changed since station {} signed it: {} seconds linked by SHA-256, each with its motion, forces, events and clocks", "station", "seconds") \
  KIND(unchanged_open, unchanged, "nothing in the file was changed since it was recorded: {} seconds linked by SHA-256, each with its motion, forces, events and clocks", "seconds") \
  KIND(motion_gives_forces, motion_gives_forces, "the motion gives the recorded forces, removed leaves and tooth again, bit for bit: {} ticks simulated", "ticks") \
  KIND(motion_gives_events, motion_gives_events, "the motion gives the recorded events again", ) \
  KIND(motion_gives_result, motion_gives_events, "the motion gives the recorded events and the sealed result again", ) \
  KIND(closed_by, closed_by, "closed on {} by station {}", "utc", "station") \
  KIND(closed_by_beginner, closed_by, "closed on {} by station {}, which signed its beginning, too", "utc", "station") \
  KIND(promised, promised, "the school with key {} promised this exam to candidate {}: scenario, tooth, rubric and accommodations are those of the ticket, and it began within its time", "school", "candidate") \
  /* of remarks */ \
  KIND(school_not_compared, school_not_compared, "whether the key {}… is your school's was not compared: name it with --school-key, or put its school.pub into the station's folder", "key") \
  KIND(ticket_not_read, ticket_not_read, "whether the session holds a ticket could not be read for certain", ) \
  KIND(no_ticket, no_ticket, "there is no ticket: that this exam was asked for, and of whom, is not shown", ) \
  KIND(tried_to_leave, tried_to_leave, "during the exam, {} after its beginning: {} (times in all: {})", "t_s", "what", "times") \
  KIND(moved, moved, "from {} on it was recorded at another place, for the first one refused: what lies there is the beginning of this exam", "t_s") \
  KIND(log_beside, log_beside, "a log lies beside the file ({}-wal) and was read with it: when something does not hold, look at the file without it", "path") \
  KIND(station_not_known, station_not_known, "whether station {}… is one of the school's is known to its ledger only: anybody can sign a recording with a key of their own", "key") \
  KIND(hand_not_shown, hand_not_shown, "not shown by any file: whose hand held the stylus, and whether the station's own key or program was in the wrong hands", ) \
  KIND(earlier_end_not_shown, earlier_end_not_shown, "not shown by any file: that it was not ended before, where the station's memory was put back as it was, or its key was used by another program", ) \
  KIND(other_exam_not_shown, other_exam_not_shown, "that no other exam was sat with the same ticket is known to the ledger only", ) \
  KIND(clock_set_back, clock_set_back, "by the computer's clock it is older than the one before; the clock was set back", ) \
  KIND(clock_ahead, clock_ahead, "bears a time that has not come yet, {}; the clock was ahead then, or is behind now", "utc") \
  KIND(restored, restored, "on {} the ledger went on from a backup (entries: {}); nothing was known to be lost", "utc", "entries") \
  KIND(restored_with_loss, restored, "on {} the ledger went on from a backup (entries: {}); later entries were lost, which the school accepted: {} ({})", "utc", "entries", "lost", "reason") \
  KIND(receipt_lost, restored, "the entry on the receipt was lost when the ledger went on from a backup (entry {}): file its session again", "by") \
  KIND(contested, contested, "is contested by entry {}, another ending of the same exam: a person has chosen which counts", "by") \
  KIND(contested_open, contested, "is contested by entry {}, another ending of the same exam: a person decides which counts", "by") \
  KIND(release_void, release_void, "has not released entry {}, for it names entry {}, too, another ending of the same exam, and one counts: choose it with --session", "of", "other") \
  KIND(release_other_chosen, release_void, "has not released entry {}, for entry {}, another ending of the same exam, was chosen before", "of", "other") \
  KIND(release_made_up, release_void, "has not released entry {}, for the makeup sitting of entry {} counts in its place", "of", "other") \
  KIND(release_other_sitting, release_void, "has not released entry {}, for entry {}, another sitting of the same exam, is released", "of", "other")
// clang-format on

CAVUM_FACTS(FindingKind, CAVUM_LEDGER_FINDINGS)

struct Finding : TableFact<FindingKind> {
  std::optional<std::uint64_t> entry =
      {};                  ///< of the ledger that is checked, where it is about one
  std::string where = {};  ///< the file that it is about, where that was named

  Finding() = default;
  Finding(TableFact<FindingKind> of)
      : TableFact(std::move(of)) {}  // NOLINT(google-explicit-constructor)
  Finding(const Damage& damage)
      : TableFact{static_cast<FindingKind>(damage.kind), damage.values} {
  }  // NOLINT(google-explicit-constructor)
  [[nodiscard]] Finding in_entry(std::uint64_t seq) const;
  /// "receipt.json: entry 7: ..."
  [[nodiscard]] Message message() const;
  friend bool operator==(const Finding&, const Finding&) = default;
};
using Findings = std::vector<Finding>;

/// A finding of this kind: the compiler counts its values.
template <FindingKind kind, class... A>
[[nodiscard]] Finding finding(A&&... values) {
  return fact_of<kind>(std::forward<A>(values)...);
}

[[nodiscard]] std::vector<Message> words_of(const Findings& findings);
/// Of that file, each.
[[nodiscard]] Findings named(const std::string& where, Findings findings);
void append(Findings& to, const Findings& more);
void append(Findings& to, const Damages& more);

/// For other programs: {"kind", "group", "values", "text", "entry", "where"}.
void to_json(nlohmann::json& json, const Finding& finding);
// As our own files keep it: {"kind", "values", "entry", "where"}.
[[nodiscard]] nlohmann::json write_json(const Finding& finding);
void read_json(const nlohmann::json& from, const JsonLocation& at, Finding& finding);

}  // namespace cavum::records
