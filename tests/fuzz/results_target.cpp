// Exported results: the bytes as they are, and the same facts under a signature that holds.
#include "engine/base/json_reader.h"
#include "grading/records/exports.h"
#include "grading/records/registry.h"
#include "tests/fuzz/material.h"
#include "tests/fuzz/targets.h"

namespace cavum::fuzz {

void fuzz_results(Data data) {
  const std::string text = text_of(data), school = to_hex(school_key().public_key);
  for (const records::LedgerContent* ledger :
       {static_cast<const records::LedgerContent*>(nullptr), &school_ledger()})
    static_cast<void>(records::check_results(text, school, ledger));
  auto facts = parse_json_or_null(text);
  if (!facts.is_object()) return;
  facts.erase("signature");
  facts["public_key"] = school;
  try {
    const std::string signed_text = "CVRESULT" + facts.dump();
    facts["signature"] = to_hex(school_key().sign(bytes_of(signed_text)));
    static_cast<void>(records::check_results(facts.dump(), school, &school_ledger()));
  } catch (const nlohmann::json::exception&) {  // our own writing of a text that is no UTF-8
  }
}

std::vector<Bytes> results_seeds() {
  static_cast<void>(school_ledger());
  const records::Ledger ledger(work_folder() + "/ledger", school_key());
  records::Registry registry = records::read_registry(ledger.content());
  const std::string none = records::signed_results(registry, ledger);
  records::FiledSession s;
  s.seq = s.result_seq = 1;
  s.candidate = "C-7K3M-92PQ-XD4V";
  s.file_sha256 = s.chain_sha256 = std::string(64, 'a');
  s.result = s.filed = s.shown = parse_json_or_null(small_result());
  s.released = true;
  s.findings = {records::finding<records::FindingKind::ticket_artifact>("a finding")};
  registry.sessions.push_back(s);
  return {bytes_of(none), bytes_of(records::signed_results(registry, ledger))};
}

}  // namespace cavum::fuzz
