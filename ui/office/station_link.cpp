#include "ui/office/station_link.h"

#include <fmt/core.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>

#include "engine/base/file.h"
#include "engine/base/file_name.h"
#include "engine/base/hash.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/message_from.h"
#include "engine/base/write_file.h"
#include "engine/session/session_image.h"
#include "engine/session/session_reader.h"
#include "grading/records/ticket.h"
#include "ui/office/station_client.h"

namespace cavum::office {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr int k_report_ms = 1000, k_look_ms = 5000, k_ask_ms = 500, k_longest_wait_ms = 10'000;
constexpr auto k_patience_of_reports = std::chrono::seconds(10),
               k_patience_to_begin = std::chrono::seconds(5);

std::int64_t steady_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// The exam's threads go first.
void stand_back() noexcept {
  ::setpriority(PRIO_PROCESS, static_cast<id_t>(::syscall(SYS_gettid)), 15);
}

std::string beside(const std::string& recording, const char* what) {
  return fs::path(recording).replace_extension(what).string();
}
std::string receipt_of(const std::string& recording) { return beside(recording, ".receipt.json"); }
std::string refusal_of(const std::string& recording) { return beside(recording, ".refused.json"); }

}  // namespace

std::optional<HandedIn> StationLink::outcome(const std::string& recording) {
  std::error_code none;
  if (fs::exists(receipt_of(recording), none)) {
    const json receipt = parse_json_or_null(read_text_file(receipt_of(recording)), k_json_part);
    return HandedIn{true, static_cast<std::uint64_t>(whole_in(receipt, "seq")), {}};
  }
  if (!fs::exists(refusal_of(recording), none)) return std::nullopt;
  HandedIn refused;
  const json said = parse_json_or_null(read_text_file(refusal_of(recording)), k_json_part);
  for (const json& f : member_of(said, "findings")) refused.findings.push_back(text_in(f, "text"));
  return refused;
}

StationLink::StationLink(const LinkOptions& options, const SigningKey& key)
    : options_(options), key_(key), answered_ns_(steady_ns()) {
  const auto client = [&] {
    return std::make_unique<StationClient>(options_.server, options_.certificate, options_.school,
                                           key_);
  };
  speaking_ = client();
  speaking_->set_patience(k_patience_of_reports);
  filing_ = client();
  make_private_folder(options_.tickets);
  speaker_ = std::thread([this] { speak(); });
  filer_ = std::thread([this] { hand_in_all(); });
}

StationLink::~StationLink() {
  {
    const std::lock_guard guard(lock_);
    ending_ = true;
  }
  speaking_->stop();
  filing_->stop();
  speak_.notify_all();
  file_.notify_all();
  speaker_.join();
  filer_.join();
}

void StationLink::say(const StationReport& report) {
  const std::lock_guard guard(lock_);
  said_ = report;
}

LinkView StationLink::view() const {
  const std::lock_guard guard(lock_);
  LinkView v = view_;
  v.silent_s = static_cast<double>(steady_ns() - answered_ns_) * 1e-9;
  if (v.hold == released_) v.hold = 0;
  return v;
}

void StationLink::read(std::uint64_t entry) {
  const std::lock_guard guard(lock_);
  received_ = std::max(received_, entry);
  std::erase_if(view_.told, [&](const ReceivedAnnouncement& t) { return t.entry <= entry; });
}

void StationLink::release(std::uint64_t hold) {
  const std::lock_guard guard(lock_);
  released_ = hold;
}

void StationLink::recording(const std::string& path) {
  const std::lock_guard guard(lock_);
  under_way_ = path;
}

void StationLink::hand_in() {
  const std::lock_guard guard(lock_);
  look_ = true;
  file_.notify_all();
}

std::string StationLink::begin(const std::string& nonce) {
  StationClient client(options_.server, options_.certificate, options_.school, key_);
  client.set_patience(k_patience_to_begin);
  try {
    return client.begin(nonce);
  } catch (const OfficeUnreachable&) {
    return {};
  }
}

bool StationLink::wait(std::unique_lock<std::mutex>& guard, std::condition_variable& come, int ms) {
  come.wait_for(guard, std::chrono::milliseconds(ms),
                [&] { return ending_ || (&come == &file_ && look_); });
  return !ending_;
}

void StationLink::speak() {
  stand_back();
  int pause_ms = k_report_ms;
  std::unique_lock guard(lock_);
  while (!ending_) {
    said_.heard = received_;
    const json report = to_json_value(said_);
    guard.unlock();
    Message trouble;
    try {
      const json word = speaking_->report(report);
      if (whole_in(word, "tickets") != tickets_) {
        fetch_tickets(*speaking_);
        tickets_ = whole_in(word, "tickets");
      }
      take(word);
      pause_ms = k_report_ms;
    } catch (const std::exception&
                 wrong) {  // the network, a refusal, an answer that is none: it goes on without
      trouble = message_from(wrong);
      pause_ms = std::min(2 * pause_ms, k_longest_wait_ms);
    }
    guard.lock();
    view_.reached = trouble.empty();
    view_.trouble = trouble;
    if (!wait(guard, speak_, pause_ms)) return;
  }
}

void StationLink::take(const json& word) {
  const std::lock_guard guard(lock_);
  answered_ns_ = steady_ns();
  const json& hold = member_of(word, "hold");
  view_.hold = hold.is_object() ? static_cast<std::uint64_t>(whole_in(hold, "entry")) : 0;
  view_.hold_reason = text_in(hold, "reason");
  view_.told.clear();
  for (const json& a : member_of(word, "announcements"))
    if (const auto entry = static_cast<std::uint64_t>(whole_in(a, "entry")); entry > received_)
      view_.told.push_back({entry, text_in(a, "text"), whole_in(a, "utc_ns")});
}

void StationLink::fetch_tickets(StationClient& client) {
  std::set<std::string> live;
  for (const json& t : client.tickets()) {
    const std::string text = text_in(t, "text");
    const records::Ticket ticket =
        records::parse_ticket(text, options_.school, msg("the office's ticket"));
    const std::string path =
        fmt::format("{}/{}.ticket", options_.tickets, file_name_of(ticket.candidate));
    live.insert(path);
    std::error_code none;
    if (!fs::exists(path, none) || read_text_file(path) != text) {
      fs::remove(beside(path, ".begin"), none);  // of a ticket that this one takes the place of
      write_private_text_file(path, text);
    }
  }
  for (const auto& file : fs::directory_iterator(options_.tickets)) {
    const std::string path = file.path().string();
    if (!path.ends_with(".ticket") ||
        live.contains(options_.tickets + "/" + file.path().filename().string()))
      continue;
    fs::remove(beside(path, ".begin"));
    fs::remove(path);
  }
}

bool StationLink::is_ours(const std::string& path) {
  if (not_ours_.contains(path)) return false;
  std::error_code none;
  if (fs::exists(receipt_of(path), none) || fs::exists(refusal_of(path), none)) return false;
  try {
    const SessionReader session(path);
    if (!session.closed()) return false;  // it may be gone on with
    const SessionSetup setup = session.setup();
    const auto note = std::find_if(setup.notes.begin(), setup.notes.end(),
                                   [](const auto& n) { return n.first == records::k_ticket_note; });
    if (note != setup.notes.end()) {
      static_cast<void>(records::parse_ticket(note->second, options_.school, path));
      return true;
    }
  } catch (
      const std::exception&) {  // damaged, or of another school: a person hands it in, or nobody
  }
  not_ours_.insert(path);
  return false;
}

std::vector<std::string> StationLink::recordings_left() {
  std::string under_way;
  {
    const std::lock_guard guard(lock_);
    under_way = under_way_;
  }
  std::vector<std::string> out;
  std::error_code none;
  const auto add = [&](const fs::path& path) {
    if (path.extension() == ".cavum" &&
        (under_way.empty() || !fs::equivalent(path, under_way, none)) && is_ours(path.string()))
      out.push_back(path.string());
  };
  for (const auto& place : options_.recordings) {
    if (!fs::is_directory(place, none)) {
      if (fs::exists(place, none)) add(place);
      continue;
    }
    for (const auto& file : fs::directory_iterator(place, none)) add(file.path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

bool StationLink::file(StationClient& client, const std::string& path) {
  Damages findings;
  const Bytes image = read_session_image(path, findings);
  const std::string hash = to_hex(sha256(image));
  json state = client.handed(hash);
  while (true) {
    const std::string word = text_in(state, "state");
    if (word == "filed")
      return write_private_text_file(receipt_of(path), state.at("receipt").dump(2) + "\n"), true;
    if (word == "refused")
      return write_private_text_file(refusal_of(path),
                                     json{{"findings", state.at("findings")}}.dump(2) + "\n"),
             false;
    if (word == "unknown") client.hand_in(image);  // never sent, or lost on the way
    std::unique_lock guard(lock_);
    if (!wait(guard, speak_, k_ask_ms))
      throw OfficeUnreachable(Name{path}, msg("is not handed in yet: this station ends"),
                              msg("begin again"));
    guard.unlock();
    state = client.handed(hash);
  }
}

void StationLink::hand_in_all() {
  stand_back();
  std::unique_lock guard(lock_);
  while (!ending_) {
    look_ = false;
    guard.unlock();
    std::vector<std::string> refused;
    try {
      auto left = recordings_left();
      while (!left.empty()) {
        {
          const std::lock_guard inner(lock_);
          view_.waiting = left.size();
        }
        if (!file(*filing_, left.back()))
          refused.push_back(fs::path(left.back()).filename().string());
        left.pop_back();
      }
      const std::lock_guard inner(lock_);
      view_.waiting = 0;
    } catch (const std::exception&) {  // the network, or a disk that refuses: again later; the
                                       // thread that speaks says what is wrong
    }
    guard.lock();
    view_.failed.insert(view_.failed.end(), refused.begin(), refused.end());
    if (!wait(guard, file_, k_look_ms)) return;
  }
}

}  // namespace cavum::office
