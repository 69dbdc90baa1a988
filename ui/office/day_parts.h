// What the board shows of a day: who has one candidate twice, who has not read what was announced,
// and what is paused.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "grading/records/registry.h"
#include "ui/office/wire.h"

namespace cavum::office {

/// For how long an announcement is shown to stations that have not read it.
inline constexpr std::int64_t k_announced_ns = 3'600'000'000'000;
/// Of what was announced before a candidate signed in he sees no more than this.
inline constexpr std::int64_t k_before_sign_in_ns = 120'000'000'000;
/// A station that has said nothing for so long is taken for gone.
inline constexpr std::int64_t k_silent_ns = 15'000'000'000;

/// What stations said, by key (Board::stations()).
using Said = std::map<std::string, StationStatus>;

/// The station that has the office's word to begin the exam of each candidate, by pseudonym: while
/// its ticket is good.
[[nodiscard]] std::map<std::string, std::string> begun_at(const records::LedgerContent& content,
                                                          const records::Registry& registry);
/// Names of other stations that have the candidate whom this one has, or asked for: by what they
/// say, or by the office's word (`begun`).
[[nodiscard]] std::vector<std::string> twins_of(const records::StationRegister& stations,
                                                const std::map<std::string, std::string>& begun,
                                                const std::string& key, const Said& said,
                                                std::int64_t now_utc_ns);
/// Announcements for whoever is at this station: made since he signed in (`since_utc_ns`; 0: nobody
/// did, and it is now), or shortly before that.
[[nodiscard]] std::vector<const records::Announcement*> announced_to(const records::ExamDay& day,
                                                                     const std::string& key,
                                                                     std::int64_t since_utc_ns,
                                                                     std::int64_t now_utc_ns);
/// How many of them he has not read; 0 where nobody is to read any: nobody has signed in, or his
/// exam is over.
[[nodiscard]] std::size_t unread_by(const records::ExamDay& day, const std::string& key,
                                    const Said& said, std::int64_t now_utc_ns);
/// Each that lasts.
[[nodiscard]] std::vector<Notice> shown_holds(const records::ExamDay& day);
/// Each that is still shown, the newest first.
[[nodiscard]] std::vector<Notice> shown_announcements(const records::ExamDay& day,
                                                      std::int64_t now_utc_ns);
/// Throws Error when it names nobody.
[[nodiscard]] records::Audience audience_of(const ForWhom& to,
                                            const records::StationRegister& stations);

}  // namespace cavum::office
