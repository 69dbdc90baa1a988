#include "ui/office/inbox.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <optional>

#include "engine/base/file.h"
#include "engine/base/hash.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/json_struct.h"
#include "engine/base/memory_reserve.h"
#include "engine/base/message_from.h"
#include "engine/base/text.h"
#include "engine/session/session_image.h"
#include "engine/session/session_reader.h"

namespace cavum::office {
namespace {

using nlohmann::json;
using records::FindingKind;

constexpr char k_part[] = ".part";
constexpr auto k_before_again = std::chrono::seconds(5);
constexpr std::size_t k_hash_letters = 64;

/// What a file says of itself; with findings, it is no exam that was closed.
Handed facts_of(const std::string& path) {
  constexpr std::size_t k_longest_candidate = 200;
  Handed facts;
  Damages left_out;
  try {
    const Bytes image = read_session_image(path, left_out);
    const SessionReader session(image, path);
    const bool closed = session.closed();
    if (!closed && session.findings().empty())
      facts.findings.push_back(damage<DamageKind::not_closed>(session.ticks()));
    if (!closed) append(facts.findings, session.findings());
    if (closed) facts.station = to_hex(session.seal()->public_key);
    const std::string candidate = session.setup().candidate;
    if (candidate.size() <= k_longest_candidate) facts.candidate = one_line(candidate);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    if (facts.findings.empty()) append(facts.findings, left_out);
    if (facts.findings.empty())
      facts.findings.push_back(records::finding<FindingKind::file_unreadable>(message_from(e)));
  }
  return facts;
}

}  // namespace

Message with_location_as(const Message& message, const std::string& place, const Message& name) {
  if (message.empty()) return message;
  const auto in_name = [&](const std::string& text) -> Value {
    if (text == place) return name;
    if (text.starts_with(place + "/")) return msg("{}: {}", name, text.substr(place.size() + 1));
    return Name{text};
  };
  std::vector<Value> values;
  for (const Value& value : message.values()) {
    if (const auto* text = std::get_if<Name>(&value))
      values.push_back(in_name(text->text));
    else if (const auto* file = std::get_if<FileLocation>(&value);
             file != nullptr && (file->file == place || file->file.starts_with(place + "/")))
      values.push_back(in_name(file->file));
    else if (const auto* inner = std::get_if<Message>(&value))
      values.emplace_back(with_location_as(*inner, place, name));
    else if (const auto* list = std::get_if<cavum::List>(&value)) {
      cavum::List items{{}, list->sentences};
      for (const Message& item : list->items)
        items.items.push_back(with_location_as(item, place, name));
      values.emplace_back(std::move(items));
    } else
      values.push_back(value);
  }
  return {message.english(), message.plural(), message.count(), std::move(values)};
}

Arriving::Arriving(const std::string& folder, std::string sha256)
    : folder_(folder),
      sha256_(std::move(sha256)),
      path_(temporary_name_next_to(folder + "/" + sha256_ + ".cavum")) {
  file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (file_ < 0) throw Error(folder_, msg("takes no file"), msg("make room on the disk"));
  crypto_hash_sha256_init(&hash_);
}

Arriving::~Arriving() {
  if (file_ >= 0) ::close(file_);
  if (!path_.empty()) ::unlink(path_.c_str());
}

void Arriving::take(std::string_view part) {
  crypto_hash_sha256_update(&hash_, reinterpret_cast<const unsigned char*>(part.data()),
                            part.size());
  while (!part.empty() && !refused_) {
    const ssize_t written = ::write(file_, part.data(), part.size());
    if (written > 0)
      part.remove_prefix(static_cast<std::size_t>(written));
    else if (written == 0 || errno != EINTR)
      refused_ = true;
  }
}

void Arriving::keep() {
  Sha256 hash{};
  crypto_hash_sha256_final(&hash_, hash.data());
  if (to_hex(hash) != sha256_)
    throw Error(msg("the session"), msg("is not the one whose hash was named"),
                msg("send it again"));
  if (refused_ || ::fsync(file_) != 0)
    throw DatabaseError(folder_, msg("cannot be written"),
                        msg("make room on the disk, and send it again"), {DiskFault::input_output});
  ::close(file_);
  file_ = -1;
  // the same exam sent twice at once: either file is it
  static_cast<void>(put_in_place(path_, folder_ + "/" + sha256_ + ".cavum"));
}

Inbox::Inbox(std::string folder, std::string ledger_folder, SigningKey school,
             records::FilingOptions options, std::function<void()> filed)
    : folder_(std::move(folder)),
      ledger_folder_(std::move(ledger_folder)),
      school_(school),
      options_(options),
      filed_(std::move(filed)) {
  make_private_folder(folder_ + "/refused");
  for (const auto& file : std::filesystem::directory_iterator(
           folder_)) {  // of before: sent and not filed, or not sent whole
    const std::string name = file.path().filename().string();
    if (name.ends_with(k_part)) std::filesystem::remove(file.path());
    if (name.size() != k_hash_letters + 6 || !name.ends_with(".cavum")) continue;
    queue_.push_back(name.substr(0, k_hash_letters));
    handed_[queue_.back()].state = Handed::State::waiting;
  }
  for (const auto& file : std::filesystem::directory_iterator(folder_ + "/refused")) {
    if (file.path().extension() != ".json") continue;
    const std::string hash = file.path().stem().string();
    const json kept = parse_json_or_null(read_text_file(file.path().string()));
    Handed& h = handed_[hash];
    if (h.state == Handed::State::waiting) continue;
    h.state = Handed::State::refused;
    try {
      h.findings =
          json_value_of<records::Findings>(member_of(kept, "findings"), {msg("the inbox"), {}});
    } catch (const Error&) {
      h.findings = {records::finding<FindingKind::refusal_unreadable>()};
    }
    const auto word = [&](const char* name) {
      return member_of(kept, name).is_string() ? member_of(kept, name).get<std::string>() : "";
    };
    h.station = word("station");
    h.candidate = word("candidate");
    refused_.push_back(hash);
  }
  worker_ = std::thread([this] { work(); });
}

Inbox::~Inbox() {
  {
    const std::lock_guard guard(lock_);
    stopping_ = true;
    come_.notify_all();
  }
  worker_.join();
}

std::unique_ptr<Arriving> Inbox::receive(const std::string& sha256) const {
  return std::make_unique<Arriving>(folder_, sha256);
}

void Inbox::adopt(const std::string& path, const std::string& sha256, const std::string& station) {
  if (!put_in_place(path, path_of(sha256)))
    ::unlink(path.c_str());  // handed in by another one meanwhile: either file is it
  add(sha256, station);
}

void Inbox::add(const std::string& sha256, const std::string& station) {
  const std::lock_guard guard(lock_);
  Handed& h = handed_[sha256];
  if (h.state == Handed::State::waiting) return;
  h = {Handed::State::waiting, 0, {}, station};
  std::erase(refused_, sha256);
  queue_.push_back(sha256);
  come_.notify_all();
}

Handed Inbox::of(const std::string& sha256) const {
  const std::lock_guard guard(lock_);
  const auto found = handed_.find(sha256);
  return found == handed_.end() ? Handed{} : found->second;
}

std::size_t Inbox::waiting() const {
  const std::lock_guard guard(lock_);
  return queue_.size();
}

std::vector<std::pair<std::string, Handed>> Inbox::refused() const {
  const std::lock_guard guard(lock_);
  std::vector<std::pair<std::string, Handed>> out;
  for (const auto& hash : refused_) out.emplace_back(hash, handed_.at(hash));
  return out;
}

Message Inbox::trouble() const {
  const std::lock_guard guard(lock_);
  return trouble_;
}

void Inbox::work() {
  for (std::unique_lock guard(lock_);;) {
    come_.wait(guard, [&] { return stopping_ || !queue_.empty(); });
    if (stopping_) return;
    const std::string hash = queue_.front();
    guard.unlock();
    const bool done = file(hash);
    guard.lock();
    queue_.pop_front();
    if (!done) {  // the others have their turn first
      queue_.push_back(hash);
      come_.wait_for(guard, k_before_again, [&] { return stopping_; });
    }
    guard.unlock();
    filed_();
    guard.lock();
  }
}

bool Inbox::file(const std::string& hash) {
  Message trouble;
  try {
    keep_memory_reserve();
    Handed facts = facts_of(path_of(hash));
    if (!facts.findings.empty()) {
      refuse(hash, std::move(facts));
      return true;
    }
    if (!ledger_) ledger_ = std::make_unique<records::Ledger>(ledger_folder_, school_);
    ledger_->refresh();
    const auto& sessions = ledger_->registry().sessions;
    const auto before =
        std::find_if(sessions.begin(), sessions.end(),
                     [&](const records::FiledSession& s) { return s.file_sha256 == hash; });
    std::optional<std::uint64_t> entry;
    if (before !=
        sessions.end()) {  // killed, or without room for the witness, between the entry and this
      entry = before->seq;
    } else {
      const records::Filing filing =
          records::file_session(*ledger_, path_of(hash), options_, grounds_);
      if (!filing.seq) {
        facts.findings = filing.findings;
        refuse(hash, std::move(facts));
        return true;
      }
      entry = filing.seq;
    }
    std::filesystem::remove(path_of(hash));
    const std::lock_guard guard(lock_);
    handed_[hash] = {Handed::State::filed, *entry, {}};
    trouble_ = {};
    return true;
  } catch (const Error& e) {  // the disk, the ledger: nothing that the exam is to blame for, and it
                              // stays where it lies
    trouble = without_locations(e.message(), hash);
    ledger_.reset();
  } catch (const std::exception& e) {  // memory
    trouble = Name{e.what()};
    ledger_.reset();
  }
  const std::lock_guard guard(lock_);
  trouble_ = trouble;
  return false;
}

void Inbox::refuse(const std::string& hash, Handed why) {
  why.state = Handed::State::refused;
  for (records::Finding& f : why.findings)
    f.values = without_locations({"", nullptr, 0, f.values}, hash).values();
  if (const std::string sender = of(hash).station; !sender.empty()) why.station = sender;
  const json kept{{"findings", to_json_value(why.findings)},
                  {"station", why.station},
                  {"candidate", why.candidate}};
  write_private_text_file(fmt::format("{}/refused/{}.json", folder_, hash),
                          kept.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
  std::filesystem::rename(path_of(hash), fmt::format("{}/refused/{}.cavum", folder_, hash));
  const std::lock_guard guard(lock_);
  handed_[hash] = std::move(why);
  refused_.push_back(hash);
  trouble_ = {};
}

Message Inbox::without_locations(const Message& message, const std::string& hash) const {
  Message out = with_location_as(message, path_of(hash), msg("the recording"));
  out = with_location_as(out, folder_, msg("the inbox"));
  return with_location_as(out, ledger_folder_, msg("the ledger"));
}

}  // namespace cavum::office
