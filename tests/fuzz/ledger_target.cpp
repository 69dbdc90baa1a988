// What people hand to the ledger as text: tickets, receipts, the class, marks.
#include "grading/cohort/class_figures.h"
#include "grading/records/issue.h"
#include "tests/fuzz/material.h"
#include "tests/fuzz/targets.h"

namespace cavum::fuzz {

void fuzz_ticket(Data data) {
  static const SessionSetup k_setup = small_setup();
  const std::string text = text_of(data);
  for (const std::string& school : {std::string(), to_hex(school_key().public_key)}) {
    try {
      const records::Ticket ticket = records::parse_ticket(text, school, "ticket");
      static_cast<void>(records::check_ticket(ticket, k_setup, ticket.not_before_utc_ns));
      static_cast<void>(records::sign_ticket(ticket, school_key()));
    } catch (const Error&) {
    }
  }
  try {  // the same facts under a signature that holds: what follows the signature must bear them,
         // too
    const auto facts = nlohmann::json::parse(text, nullptr, false);
    if (!facts.is_object() || !facts.contains("ticket") || !facts["ticket"].is_object()) return;
    nlohmann::json mine = facts["ticket"];
    mine["public_key"] = to_hex(school_key().public_key);
    const std::string signed_text =
        "CVTICKET" + mine.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    const auto signature = school_key().sign(bytes_of(signed_text));
    const records::Ticket ticket = records::parse_ticket(
        nlohmann::json{
            {"grant", facts.value("grant", "")}, {"signature", to_hex(signature)}, {"ticket", mine}}
            .dump(),
        "", "ticket");
    static_cast<void>(records::check_ticket(ticket, k_setup, ticket.not_after_utc_ns));
  } catch (const Error&) {
  } catch (const nlohmann::json::exception&) {  // our own writing of a text that is no UTF-8
  }
}

void fuzz_receipt(Data data) {
  const auto receipt = nlohmann::json::parse(data.begin(), data.end(), nullptr, false);
  for (const records::LedgerContent* ledger :
       {static_cast<const records::LedgerContent*>(nullptr), &school_ledger()})
    static_cast<void>(records::check_receipt(receipt, to_hex(school_key().public_key), ledger));
}

void fuzz_candidates(Data data) {
  try {
    static_cast<void>(records::parse_people(text_of(data), "class.csv"));
  } catch (const Error&) {
  }
}

void fuzz_marks(Data data) {
  static records::Identities identities(work_folder() + "/identities.db", true);
  try {
    static_cast<void>(cohort::parse_marks(text_of(data), identities, "exam", "marks.csv", 20));
  } catch (const Error&) {
  }
}

std::vector<Bytes> ticket_seeds() { return {bytes_of(small_ticket())}; }

std::vector<Bytes> receipt_seeds() {
  static_cast<void>(school_ledger());
  const records::Ledger ledger(work_folder() + "/ledger", school_key());
  return {bytes_of(ledger.receipt(0).dump()), bytes_of(ledger.receipt(1).dump())};
}

std::vector<Bytes> candidates_seeds() {
  return {bytes_of("id,name\n4711,Ada\n4712,\"Byron, A.\"\n"),
          bytes_of("\xef\xbb\xbfname;id\r\n\"a \"\"b\"\"\";x@y.z\r\n# no\r\n\r\nc;d\r\n")};
}

std::vector<Bytes> marks_seeds() {
  return {bytes_of("candidate,judge,points\n4711,A,12.5\n4711,B,13\n4712,A,9\n"),
          bytes_of("candidate;judge;points;rating\n1;A;1e1;3\n1;B;0;\n")};
}

}  // namespace cavum::fuzz
