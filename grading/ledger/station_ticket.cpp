#include "grading/ledger/station_ticket.h"

#include <filesystem>

#include "engine/base/file.h"
#include "grading/ledger/ledger_key.h"

namespace cavum {

HeldTicket read_ticket(const std::string& path) {
  HeldTicket held{{}, read_text_file(path), path};
  while (!held.text.empty() && (held.text.back() == '\n' || held.text.back() == '\r')) held.text.pop_back();
  const std::string pinned = school_public_key_path();
  if (!std::filesystem::exists(pinned))
    throw Error(pinned, "this station knows no school yet",
                "copy the school's public key there: `cavum ledger init` writes it beside the school's key");
  std::string key = read_text_file(pinned);
  while (!key.empty() && (key.back() == '\n' || key.back() == '\r' || key.back() == ' ')) key.pop_back();
  key = parse_public_key(key, pinned);
  held.ticket = parse_ticket(held.text, key, path);
  return held;
}

void use_ticket(const HeldTicket& held, ExamOptions& options) {
  if (!options.candidate.empty() && options.candidate != held.ticket.candidate)
    throw Error("--candidate " + options.candidate, "the ticket " + held.path + " is for " + held.ticket.candidate, "leave the option out");
  if (!notes_of(options.grant).empty()) throw Error(held.path, "says itself what is granted", "leave out extra time, handedness and contrast");
  options.candidate = held.ticket.candidate;
  options.notes.insert(options.notes.end(), held.ticket.grant.begin(), held.ticket.grant.end());
  options.notes.emplace_back(k_ticket_note, held.text);
}

void require_promised(const HeldTicket& held, const SessionSetup& setup) {
  const auto wrong = check_ticket(held.ticket, setup, read_clocks().utc_ns);
  if (wrong.empty()) return;
  std::string all;
  for (const auto& w : wrong) all += (all.empty() ? "" : ", ") + w;
  throw Error(held.path, all, "ask the school for another ticket, or name the files that it promises");
}

}  // namespace cavum
