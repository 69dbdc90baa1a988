// What an office prints before an exam: cards for candidates, and the sheet that they sign.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "grading/records/ledger.h"

namespace cavum::office {

/// One whose ticket is good.
struct Invited {
  std::string code = {}, nonce = {}, id = {}, name = {}, exam = {};
  std::string title = {};  ///< of the exam; who makes the papers fills it in
  std::int64_t from_utc_ns = 0, until_utc_ns = 0;
  std::string room = {}, station = {};  ///< empty: none was given
  std::string accommodations = {};      ///< for people; who makes the cards fills it in
};
/// By time, room, station and number.
[[nodiscard]] std::vector<Invited> invited(records::Ledger& ledger, std::int64_t now_utc_ns);

// PDF, times in this computer's time zone, which is named. Each throws Error when nobody is
// invited.
[[nodiscard]] std::string candidate_cards(const std::string& school,
                                          const std::vector<Invited>& people);
[[nodiscard]] std::string sheet_to_sign(const std::string& school,
                                        const std::vector<Invited>& people);

/// "21 Nov 2026, 09:00 (CET, UTC+01:00)" as ISO date: "2026-11-21 09:00 CET (UTC+01:00)", in this
/// computer's time zone.
[[nodiscard]] std::string local_text(std::int64_t utc_ns);

}  // namespace cavum::office
