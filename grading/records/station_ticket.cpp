#include "grading/records/station_ticket.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <optional>
#include <sstream>

#include "engine/base/file.h"
#include "engine/base/system_error.h"
#include "engine/base/text.h"
#include "engine/session/station_check.h"
#include "grading/records/begin.h"
#include "grading/records/ledger_error.h"
#include "grading/records/ledger_key.h"

namespace cavum::records {

std::string station_school_key() {
  const std::string pinned = school_public_key_path();
  if (!std::filesystem::exists(pinned)) return {};
  std::string key = read_text_file(pinned);
  while (!key.empty() && (key.back() == '\n' || key.back() == '\r' || key.back() == ' '))
    key.pop_back();
  return parse_public_key(key, pinned);
}

HeldTicket read_ticket(const std::string& path) {
  HeldTicket held{{}, read_text_file(path), path};
  while (!held.text.empty() && (held.text.back() == '\n' || held.text.back() == '\r'))
    held.text.pop_back();
  const std::string key = station_school_key();
  if (key.empty())
    throw Error(
        school_public_key_path(), msg("this station knows no school yet"),
        msg("copy the school's public key there: `cavum ledger init` writes it beside the school's key"));
  held.ticket = parse_ticket(held.text, key, path);
  if (const std::string word = begin_path(path); word != path && std::filesystem::exists(word)) {
    held.begin = read_text_file(word);
    while (!held.begin.empty() && (held.begin.back() == '\n' || held.begin.back() == '\r'))
      held.begin.pop_back();
    if (parse_begin(held.begin, key, word).ticket != held.ticket.nonce)
      throw Error(word, msg("is the word to begin of another ticket"),
                  msg("ask the office for this one's"));
  }
  return held;
}

void use_ticket(const HeldTicket& held, scenarios::ExamOptions& options) {
  if (!options.candidate.empty() && options.candidate != held.ticket.candidate)
    throw Error("--candidate " + options.candidate,
                msg("the ticket {} is for {}", held.path, held.ticket.candidate),
                msg("leave the option out"));
  if (!scenarios::notes_of(options.grant).empty())
    throw Error(held.path, msg("says itself what is granted"),
                msg("leave out extra time, handedness and contrast"));
  options.candidate = held.ticket.candidate;
  options.notes.insert(options.notes.end(), held.ticket.grant.begin(), held.ticket.grant.end());
  options.notes.emplace_back(k_ticket_note, held.text);
  if (!held.begin.empty()) options.notes.emplace_back(k_begin_note, held.begin);
}

void require_promised(const HeldTicket& held, const SessionSetup& setup) {
  if (held.ticket.begun_at_ledger && held.begin.empty())
    throw Error(
        LedgerError::unknown, Name{held.path},
        msg("asks for the ledger's word to begin, and {} is not there", begin_path(held.path)),
        msg("have the office run `cavum ledger begin LEDGER --ticket {}`", held.path));
  const Findings wrong = check_ticket(held.ticket, setup, read_clocks().utc_ns);
  if (wrong.empty()) return;
  throw Error(held.path, msg("{}", List{words_of(wrong), true}),
              msg("ask the school for another ticket, or name the files that it promises"));
}

std::string used_tickets_path() { return station_path("used_tickets"); }

namespace {

struct TicketUse {
  std::string when, session;
  bool closed = false;  ///< its exam was closed
};

/// The file of used tickets, locked while this lives: two programs of a station cannot both begin
/// with one ticket.
class UsedTickets {
 public:
  UsedTickets() {
    make_private_folder(std::filesystem::path(path_).parent_path().string());
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (file_ < 0 || ::flock(file_, LOCK_EX) != 0) fail();
  }
  ~UsedTickets() { ::close(file_); }
  UsedTickets(const UsedTickets&) = delete;
  UsedTickets& operator=(const UsedTickets&) = delete;

  /// Of a ticket when the last line about it says that it was used. A line that a power cut left
  /// short is none.
  [[nodiscard]] std::optional<TicketUse> use_of(const std::string& nonce) {
    std::istringstream lines(read_text_file(path_));
    std::optional<TicketUse> use;
    for (std::string line; std::getline(lines, line);) {
      std::istringstream words(line);
      std::string what, of, when, session;
      words >> what >> of >> when;
      if (of != nonce) continue;
      std::getline(words >> std::ws, session);
      use.reset();
      if (what == "used" || what == "closed") use = {when, session, what == "closed"};
    }
    return use;
  }
  void add(const std::string& line) {
    const std::string whole = line + "\n";
    if (::write(file_, whole.data(), whole.size()) != static_cast<ssize_t>(whole.size()) ||
        ::fsync(file_) != 0)
      fail();
  }

 private:
  [[noreturn]] void fail() const {
    const Message why = system_words(errno);
    if (file_ >= 0) ::close(file_);
    throw Error(path_, msg("cannot remember which tickets were used ({})", why),
                msg("make the folder writable, and room on its disk"));
  }

  std::string path_ = used_tickets_path();
  int file_ = -1;
};

/// Of the ticket in a session's notes; empty without one.
std::string nonce_in(const std::vector<std::pair<std::string, std::string>>& notes,
                     const std::string& session) {
  for (const auto& [key, value] : notes)
    if (key == k_ticket_note) return parse_ticket(value, "", session + ": ticket").nonce;
  return "";
}

void refuse_used(const HeldTicket& held, const std::optional<TicketUse>& use) {
  if (use)
    throw Error(LedgerError::used, Name{held.path},
                msg("was used at this station on {} for {}", use->when, use->session),
                msg("go on with that exam (--resume), or ask the school for a new ticket"));
}

}  // namespace

void require_unused(const HeldTicket& held) {
  if (std::filesystem::exists(used_tickets_path()))
    refuse_used(held, UsedTickets().use_of(held.ticket.nonce));
}

void remember_use(const HeldTicket& held, const std::string& session) {
  UsedTickets used;
  refuse_used(held, used.use_of(held.ticket.nonce));
  used.add(fmt::format("used {} {} {}", held.ticket.nonce, utc_text(read_clocks().utc_ns),
                       one_line(session)));
}

void remember_closed(const std::vector<std::pair<std::string, std::string>>& notes,
                     const std::string& session) noexcept {
  try {
    const std::string nonce = nonce_in(notes, session);
    if (!nonce.empty())
      UsedTickets().add(
          fmt::format("closed {} {} {}", nonce, utc_text(read_clocks().utc_ns), one_line(session)));
  } catch (const std::exception&) {  // the exam is sealed all the same, and the ledger takes the
                                     // first that is handed in
  }
}

bool require_not_closed(const std::vector<std::pair<std::string, std::string>>& notes,
                        const std::string& session) {
  const std::string nonce = nonce_in(notes, session);
  if (nonce.empty()) return true;
  std::optional<TicketUse> use;
  if (std::filesystem::exists(used_tickets_path())) use = UsedTickets().use_of(nonce);
  if (use && use->closed)
    throw Error(session,
                msg("the exam of its ticket was closed at this station on {} for {}", use->when,
                    use->session),
                msg("hand that one in: an exam that was closed is not taken up again"));
  return use.has_value();
}

void forget_use(const HeldTicket& held) noexcept {
  try {
    UsedTickets().add(
        fmt::format("not-begun {} {}", held.ticket.nonce, utc_text(read_clocks().utc_ns)));
  } catch (
      const std::exception&) {  // the ticket then counts as used here: the school gives another
  }
}

}  // namespace cavum::records
