// What the window and the exam office have to do with each other: the office is told what the
// station does, and what it says becomes part of the state and of the recording. The network is
// StationLink's; nothing here waits for it.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "ui/office/station_link.h"
#include "ui/station/screens.h"

namespace cavum::station {

class OfficeLine {
 public:
  /// Throws Error as StationLink does, or when this station has no key.
  explicit OfficeLine(const office::LinkOptions& options);

  /// In each picture: what the office said last goes into the state and to the servo's desk; what
  /// the station does goes to the office.
  void exchange(StationState& state, Sitting* sitting);
  /// The candidate has read what was announced.
  void read(StationState& state, Sitting* sitting);
  /// An invigilator lets the exam go on although the office, which cannot be reached, has paused
  /// it.
  void release(const StationState& state, Sitting* sitting);
  /// Throws Error when the office has paused the exams here.
  static void require_free(const StationState& state);
  /// The office's word to begin, see StationLink::begin.
  [[nodiscard]] std::string begin(const std::string& ticket_nonce) {
    return link_.begin(ticket_nonce);
  }

 private:
  [[nodiscard]] static Message outcome_text(const std::string& recording);
  void note_what_was_said(const StationState& state, Sitting& sitting);

  office::StationLink link_;
  std::chrono::steady_clock::time_point told_at_;
  bool handed_in_ = true;                     // nothing new is closed
  std::uint64_t noted_hold_ = 0, noted_ = 0;  // entries that stand in this sitting's recording
  const Sitting* noted_in_ = nullptr;
};

/// What a station with this on its screen reports.
[[nodiscard]] office::StationReport office_report(const StationState& state, Sitting* sitting);
/// Of the sign-in screen: is the office there, and does something wait to be handed in? Empty
/// without an office.
[[nodiscard]] Message office_status(const StationState& state);
/// "15:19  Ten minutes left.": with the clock time here at which it was made.
[[nodiscard]] Message announcement_text(const office::ReceivedAnnouncement& told);
/// What the office says, over any screen but the exam's, which shows it in its picture.
void office_notice(const ScreenContext& c);
/// Whether the exam goes on although the office, which does not answer, has paused it. `locked`:
/// asks for the supervisor's code.
void ask_whether_to_go_on(const ScreenContext& c, bool locked);
/// The office has paused the exams here, and has not answered for so long that an invigilator may
/// decide.
[[nodiscard]] bool may_go_on_without(const StationState& state) noexcept;

}  // namespace cavum::station
