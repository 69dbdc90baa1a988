#include "grading/ledger/ledger_content.h"

#include <filesystem>
#include <set>

#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/session/session.h"
#include "engine/session/session_image.h"
#include "grading/ledger/ledger_file.h"
#include "grading/ledger/ledger_key.h"
#include "grading/ledger/merkle.h"
#include "grading/ledger/witness.h"

namespace cavum {
namespace {

using nlohmann::json;

/// Roots of the first 1, 2, 3 … leaves, for the price of one tree: complete subtrees from the left, joined from the right.
class GrowingRoot {
 public:
  Sha256 add(const Sha256& leaf) {
    complete_.push_back(leaf);
    for (std::uint64_t n = ++size_; (n & 1) == 0; n >>= 1) {
      const Sha256 right = complete_.back();
      complete_.pop_back();
      complete_.back() = node_hash(complete_.back(), right);
    }
    Sha256 root = complete_.back();
    for (std::size_t i = complete_.size() - 1; i-- > 0;) root = node_hash(complete_[i], root);
    return root;
  }

 private:
  std::vector<Sha256> complete_;
  std::uint64_t size_ = 0;
};

/// What the row says, as far as it can be read; else a finding.
LedgerEntry parse_entry(std::uint64_t seq, std::string text, const Sha256& leaf, std::string attachment, std::vector<std::string>& findings) {
  LedgerEntry e;
  e.seq = seq;
  e.leaf = leaf;
  e.text = std::move(text);
  const std::string name = "entry " + std::to_string(seq);
  if (leaf_hash(ledger_bytes(e.text)) != leaf) findings.push_back(name + ": its text was changed after it was entered");
  try {
    const json j = parse_json(e.text, name);
    e.kind = j.at("kind").get<std::string>();
    e.body = j.at("body");
    e.utc_ns = require_whole<std::int64_t>(j, "utc_ns", name);
    e.attachment = std::move(attachment);
    const std::string bound = text_in(e.body, "result_sha256");
    if (bound != (e.attachment.empty() ? "" : to_hex(sha256(e.attachment))))
      findings.push_back(name + ": its result was changed, added or removed after it was entered");
    else if (!bound.empty())
      e.body["result"] = parse_json(e.attachment, name);
    if (require_whole<std::uint64_t>(j, "seq", name) != seq)
      findings.push_back(name + ": was entered as number " + j.at("seq").dump() + ": entries were moved");
  } catch (const std::exception&) {
    findings.push_back(name + ": is no JSON object with kind, seq, utc_ns and body");
  }
  return e;
}

void check_tree(LedgerContent& c) {
  GrowingRoot growing;
  std::vector<Sha256> roots;
  for (const auto& e : c.entries) roots.push_back(growing.add(leaf_hash(ledger_bytes(e.text))));
  std::array<std::uint8_t, 32> key{};
  try {
    key = fixed_from_hex<32>(c.public_key, "public key");
  } catch (const Error&) {
    c.findings.push_back("entry 0: names no school's public key");
    return;
  }
  std::uint64_t expected = 0;
  for (const auto& p : c.checkpoints) {
    const std::string name = "checkpoint " + std::to_string(p.size);
    if (p.size != ++expected) {
      c.findings.push_back("checkpoint " + std::to_string(expected) + ": is missing");
      expected = p.size;
    }
    if (!is_signed_by(key, checkpoint_message(c.id, p), p.signature)) c.findings.push_back(name + ": the school's signature does not hold");
    if (p.size > roots.size())
      c.findings.push_back(name + ": signed for " + std::to_string(p.size) + " entries, and there are " + std::to_string(roots.size()) +
                           ": entries were taken out");
    else if (p.size > 0 && roots[p.size - 1] != p.root)
      c.findings.push_back(name + ": an entry up to number " + std::to_string(p.size - 1) + " is not what the school signed");
  }
  if (c.checkpoints.size() < c.entries.size() && expected < c.entries.size())
    c.findings.push_back("entry " + std::to_string(expected) + ": the school has signed nothing from here on");
}

/// A table that was taken out is a finding of check_schema; the others are read all the same.
bool has_table(Database& db, const std::string& name) {
  return db.integer(("SELECT count(*) FROM sqlite_schema WHERE type = 'table' AND name = '" + name + "'").c_str()) == 1;
}

/// Each as it was put there, each named by an entry, and none missing.
void read_documents(Database& db, LedgerContent& c) {
  if (has_table(db, "document")) {
    auto rows = db.prepare("SELECT sha256, bytes FROM document ORDER BY sha256");
    while (rows.step()) {
      const std::string hash = to_hex(rows.fixed_blob<32>(0));
      Bytes bytes = rows.blob(1);
      if (to_hex(sha256(bytes)) != hash) c.findings.push_back("document " + hash + ": was changed after it was entered");
      c.documents[hash] = std::move(bytes);
    }
  }
  std::set<std::string> named;
  for (const auto& e : c.entries)
    for (const auto& [name, hash] : documents_of(e)) {
      named.insert(hash);
      if (!c.documents.contains(hash))
        c.findings.push_back("entry " + std::to_string(e.seq) + ": the " + name + " that its result was marked by was taken out of the ledger");
    }
  for (const auto& [hash, bytes] : c.documents)
    if (!named.contains(hash)) c.findings.push_back("document " + hash + ": belongs to no entry; it was put into the ledger's file");
}

void check_witness(LedgerContent& c, const std::vector<Checkpoint>& witnessed) {
  c.witnessed = !witnessed.empty();
  if (witnessed.empty()) return;
  GrowingRoot growing;
  std::vector<Sha256> roots;
  for (const auto& e : c.entries) roots.push_back(growing.add(leaf_hash(ledger_bytes(e.text))));
  const Checkpoint& last = witnessed.back();
  if (last.size > roots.size())
    c.findings.push_back("the ledger was put back to an older copy: it has " + std::to_string(roots.size()) + " entries, and had " +
                         std::to_string(last.size) + " on " + utc_text(last.utc_ns));
  for (const auto& w : witnessed)
    if (w.size >= 1 && w.size <= roots.size() && roots[w.size - 1] != w.root) {
      c.findings.push_back("the ledger's first " + std::to_string(w.size) + " entries are not those of " + utc_text(w.utc_ns) +
                           ": history was rewritten");
      break;
    }
}

}  // namespace

LedgerEntry make_entry(std::uint64_t seq, const std::string& kind, json body) {
  LedgerEntry e;
  e.seq = seq;
  e.kind = kind;
  e.utc_ns = read_clocks().utc_ns;
  e.body = std::move(body);
  json told = e.body;
  if (const auto result = told.find("result"); result != told.end()) {  // apart, so that a receipt shows no marks
    e.attachment = result->dump();
    told.erase("result");
    told["result_sha256"] = to_hex(sha256(e.attachment));
  }
  e.text = json{{"body", told}, {"kind", kind}, {"seq", seq}, {"utc_ns", e.utc_ns}}.dump();
  e.leaf = leaf_hash(ledger_bytes(e.text));
  return e;
}

std::vector<Sha256> leaves_of(const LedgerContent& c) {
  std::vector<Sha256> leaves;
  for (const auto& e : c.entries) leaves.push_back(e.leaf);
  return leaves;
}

Bytes checkpoint_message(const std::string& ledger_id, const Checkpoint& p) {
  ByteWriter out;
  static constexpr char k_purpose[] = "CVCHKPT1";
  out.put_bytes({reinterpret_cast<const std::uint8_t*>(k_purpose), 8});
  out.put_string(ledger_id);
  out.put(p.size);
  out.put_bytes(p.root);
  out.put(p.utc_ns);
  return out.take();
}

std::map<std::string, std::string> documents_of(const LedgerEntry& e) {
  std::map<std::string, std::string> out;
  const json& by = e.kind == "regrade" ? member_of(e.body, "by") : json();
  if (by.is_object())
    for (const auto& [name, hash] : by.items())
      if (hash.is_string() && !name.ends_with("_sha256")) out[name] = hash.get<std::string>();  // older entries name a file that was not kept
  return out;
}

LedgerContent read_content(Database& db, const std::string& where) {
  require_ledger(db, where);
  static_cast<void>(ledger_format(db, where));
  LedgerContent c;
  check_schema(db, c.findings);
  // The witness first: it is told after each entry, so what it knows by now is in the database by then. One snapshot of the tables for the same
  // reason.
  const bool has_entries = has_table(db, "entry");
  const std::string first = has_entries ? db.text("SELECT text FROM entry WHERE seq = 0") : "";
  const json begin = parse_json_or_null(first);
  const std::string id = text_in(member_of(begin, "body"), "ledger");
  const auto witnessed = id.size() == 32 && id.find('/') == std::string::npos ? read_witness(id, c.findings) : std::vector<Checkpoint>();
  const bool alone = !db.in_transaction();
  if (alone) db.run("BEGIN");
  if (has_entries) {
    auto rows = db.prepare("SELECT seq, text, leaf_sha256, coalesce(attachment, '') FROM entry ORDER BY seq");
    for (std::uint64_t expected = 0; rows.step(); ++expected) {
      const auto seq = static_cast<std::uint64_t>(rows.integer(0));
      if (seq != expected) c.findings.push_back("entry " + std::to_string(expected) + ": is missing");
      expected = seq;
      c.entries.push_back(parse_entry(seq, rows.text(1), rows.fixed_blob<32>(2), rows.text(3), c.findings));
    }
  }
  if (has_table(db, "checkpoint")) {
    auto points = db.prepare("SELECT size, root_sha256, utc_ns, signature FROM checkpoint ORDER BY size");
    while (points.step())
      c.checkpoints.push_back({static_cast<std::uint64_t>(points.integer(0)), points.fixed_blob<32>(1), points.integer(2), points.fixed_blob<64>(3)});
  }
  if (ledger_format(db, where) >= 3) read_documents(db, c);
  if (alone) db.run("COMMIT");
  if (c.entries.empty() || c.entries[0].kind != "init") {
    c.findings.emplace_back("entry 0: does not begin a ledger");
    return c;
  }
  c.id = text_in(c.entries[0].body, "ledger");
  c.public_key = text_in(c.entries[0].body, "public_key");
  c.school = text_in(c.entries[0].body, "school");
  check_tree(c);
  check_witness(c, witnessed);
  std::int64_t before = 0;
  for (const auto& e : c.entries) {
    if (e.utc_ns < before)
      c.remarks.push_back("entry " + std::to_string(e.seq) + ": by the computer's clock it is older than the one before; the clock was set back");
    before = e.utc_ns;
  }
  return c;
}

bool holds_parts_of_a_ledger(const LedgerPlaces& places) {
  std::error_code none;
  const std::filesystem::directory_iterator sessions(places.folder + "/sessions", none);
  return std::filesystem::exists(places.identities(), none) || sessions != std::filesystem::directory_iterator();
}

LedgerContent read_ledger(const LedgerPlaces& places) {
  if (!std::filesystem::exists(places.database())) throw Error(places.folder, "holds no ledger", instead_of_none(places.database()));
  try {
    Database live = Database::open(places.database(), false);
    return read_content(live, places.database());
  } catch (const DatabaseError&) {  // a folder that may only be read, or damage: then from a copy in memory
  }
  std::vector<std::string> findings;
  Database copy = Database::from_image(read_session_image(places.database(), findings), places.database());
  try {
    LedgerContent c = read_content(copy, places.database());
    c.findings.insert(c.findings.begin(), findings.begin(), findings.end());
    return c;
  } catch (const DatabaseError& e) {
    LedgerContent damaged;
    damaged.findings = schema_findings(copy);  // the cause, when tables were altered
    if (damaged.findings.empty()) damaged.findings.emplace_back(e.what());
    return damaged;
  }
}

}  // namespace cavum
