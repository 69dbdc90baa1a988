#include "grading/ledger/ledger.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <sstream>

#include "engine/base/file.h"
#include "engine/base/json_fields.h"
#include "engine/session/session.h"
#include "engine/session/session_image.h"
#include "grading/ledger/ledger_schema.h"

namespace cavum {
namespace {

using nlohmann::json;

static_assert(k_ledger_migrations.size() == k_ledger_format);

std::span<const std::uint8_t> bytes_of(const std::string& text) { return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}; }

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
  e.leaf = leaf_hash(bytes_of(e.text));
  return e;
}

/// What the row says, as far as it can be read; else a finding.
LedgerEntry parse_entry(std::uint64_t seq, std::string text, const Sha256& leaf, std::string attachment, std::vector<std::string>& findings) {
  LedgerEntry e;
  e.seq = seq;
  e.leaf = leaf;
  e.text = std::move(text);
  const std::string name = "entry " + std::to_string(seq);
  if (leaf_hash(bytes_of(e.text)) != leaf) findings.push_back(name + ": its text was changed after it was entered");
  try {
    const json j = json::parse(e.text);
    e.kind = j.at("kind").get<std::string>();
    e.body = j.at("body");
    e.utc_ns = require_whole<std::int64_t>(j, "utc_ns", name);
    e.attachment = std::move(attachment);
    const std::string bound = text_in(e.body, "result_sha256");
    if (bound != (e.attachment.empty() ? "" : to_hex(sha256(e.attachment))))
      findings.push_back(name + ": its result was changed, added or removed after it was entered");
    else if (!bound.empty())
      e.body["result"] = json::parse(e.attachment);
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
  for (const auto& e : c.entries) roots.push_back(growing.add(leaf_hash(bytes_of(e.text))));
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

std::vector<Checkpoint> read_witness(const std::string& id, std::vector<std::string>& findings) {
  std::vector<Checkpoint> out;
  const std::string path = witness_path(id);
  if (!std::filesystem::exists(path)) return out;
  std::istringstream lines(read_text_file(path));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    Checkpoint p;
    std::string root;
    if (!(words >> p.size >> root >> p.utc_ns)) break;  // a line that a power cut left short
    try {
      p.root = fixed_from_hex<32>(root, path);
    } catch (const Error&) {
      findings.push_back(path + ": the witness was changed at entry " + std::to_string(p.size));
      break;
    }
    out.push_back(p);
  }
  return out;
}

void check_witness(LedgerContent& c, const std::vector<Checkpoint>& witnessed) {
  c.witnessed = !witnessed.empty();
  if (witnessed.empty()) return;
  GrowingRoot growing;
  std::vector<Sha256> roots;
  for (const auto& e : c.entries) roots.push_back(growing.add(leaf_hash(bytes_of(e.text))));
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

void tell_witness(const std::string& id, const Checkpoint& p) {
  const std::string path = witness_path(id);
  std::error_code ignored;
  std::filesystem::create_directories(std::filesystem::path(path).parent_path(), ignored);
  const std::string line = std::to_string(p.size) + " " + to_hex(p.root) + " " + std::to_string(p.utc_ns) + "\n";
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600);
  const bool told = fd >= 0 && ::write(fd, line.data(), line.size()) == static_cast<ssize_t>(line.size()) && ::fsync(fd) == 0;
  const int why = errno;
  if (fd >= 0) ::close(fd);
  if (!told)
    throw Error(path, std::string("the entry is in the ledger, but its witness cannot be told (") + std::strerror(why) + ")",
                "make the folder writable; the next entry tells it again");
}

/// What a database defines, by name: "table entry" and its SQL. What SQLite keeps for itself is left out.
std::map<std::string, std::string> schema_of(Database& db) {
  std::map<std::string, std::string> out;
  auto rows = db.prepare("SELECT type, name, coalesce(sql, '') FROM sqlite_schema WHERE name NOT LIKE 'sqlite\\_%' ESCAPE '\\' ORDER BY rowid");
  while (rows.step()) out[rows.text(0) + " " + rows.text(1)] = rows.text(2);
  return out;
}

/// Tables, triggers, views and indexes that are not those that this version made: a view that shows people other figures, a trigger that is gone.
void check_schema(Database& db, std::vector<std::string>& findings) {
  Database fresh = Database::open(":memory:", true);
  const auto format = std::min<std::int64_t>(db.integer("PRAGMA user_version"), k_ledger_format);
  for (std::size_t i = 0; i < static_cast<std::size_t>(std::max<std::int64_t>(format, 0)); ++i) fresh.run(k_ledger_migrations[i]);
  const auto wanted = schema_of(fresh), found = schema_of(db);
  for (const auto& [name, sql] : wanted) {
    const auto is = found.find(name);
    if (is == found.end())
      findings.push_back(name + ": was taken out of the ledger's file");
    else if (is->second != sql)
      findings.push_back(name + ": is not as this program made it; it was altered");
  }
  for (const auto& [name, sql] : found)
    if (!wanted.contains(name)) findings.push_back(name + ": does not belong to a ledger; it was put into its file");
}

LedgerContent read_content(Database& db, const std::string& where) {
  if (db.integer("PRAGMA application_id") != k_ledger_application_id) throw Error(where, "is no ledger", "make one with `cavum ledger init FOLDER`");
  LedgerContent c;
  check_schema(db, c.findings);
  // The witness first: it is told after each entry, so what it knows by now is in the database by then. One snapshot of the tables for the same
  // reason.
  const std::string first = db.text("SELECT text FROM entry WHERE seq = 0");
  const json begin = json::parse(first, nullptr, false);
  const std::string id = text_in(member_of(begin, "body"), "ledger");
  const auto witnessed = id.size() == 32 && id.find('/') == std::string::npos ? read_witness(id, c.findings) : std::vector<Checkpoint>();
  const bool alone = !db.in_transaction();
  if (alone) db.run("BEGIN");
  auto rows = db.prepare("SELECT seq, text, leaf_sha256, coalesce(attachment, '') FROM entry ORDER BY seq");
  while (rows.step()) {
    const auto seq = static_cast<std::uint64_t>(rows.integer(0));
    if (seq != c.entries.size()) c.findings.push_back("entry " + std::to_string(c.entries.size()) + ": is missing");
    c.entries.push_back(parse_entry(seq, rows.text(1), rows.fixed_blob<32>(2), rows.text(3), c.findings));
    if (c.entries.size() > seq + 1) break;
  }
  auto points = db.prepare("SELECT size, root_sha256, utc_ns, signature FROM checkpoint ORDER BY size");
  while (points.step())
    c.checkpoints.push_back({static_cast<std::uint64_t>(points.integer(0)), points.fixed_blob<32>(1), points.integer(2), points.fixed_blob<64>(3)});
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

void migrate(Database& db, const std::string& where) {
  const auto format = db.integer("PRAGMA user_version");
  if (format > k_ledger_format)
    throw Error(where, "was written by a newer version of Cavum (format " + std::to_string(format) + ")", "use that version");
  if (format == k_ledger_format) return;
  db.run("BEGIN IMMEDIATE");
  for (auto i = static_cast<std::size_t>(format); i < k_ledger_migrations.size(); ++i) db.run(k_ledger_migrations[i]);
  db.run(("PRAGMA user_version = " + std::to_string(k_ledger_format)).c_str());
  db.run("COMMIT");
}

Database open_for_adding(const std::string& path, bool make) {
  if (!make && !std::filesystem::exists(path)) throw Error(path, "there is no ledger", "make one with `cavum ledger init FOLDER`");
  Database db = Database::open(path, make);
  db.run("PRAGMA journal_mode = WAL");
  db.run("PRAGMA synchronous = FULL");
  return db;
}

void insert(Database& db, const LedgerEntry& e, const Checkpoint& p) {
  db.prepare("INSERT INTO entry (seq, text, leaf_sha256, attachment) VALUES (?, ?, ?, nullif(?, ''))")
      .bind(1, static_cast<std::int64_t>(e.seq))
      .bind(2, e.text)
      .bind(3, e.leaf)
      .bind(4, e.attachment)
      .run();
  db.prepare("INSERT INTO checkpoint (size, root_sha256, utc_ns, signature) VALUES (?, ?, ?, ?)")
      .bind(1, static_cast<std::int64_t>(p.size))
      .bind(2, p.root)
      .bind(3, p.utc_ns)
      .bind(4, p.signature)
      .run();
}

std::vector<Sha256> leaves_of(const LedgerContent& c) {
  std::vector<Sha256> leaves;
  for (const auto& e : c.entries) leaves.push_back(e.leaf);
  return leaves;
}

}  // namespace

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

std::string witness_path(const std::string& ledger_id) { return station_path("witness/" + ledger_id); }

LedgerContent read_ledger(const LedgerPlaces& places) {
  if (!std::filesystem::exists(places.database())) throw Error(places.folder, "holds no ledger", "make one with `cavum ledger init FOLDER`");
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
    damaged.findings.emplace_back(e.what());
    return damaged;
  }
}

void Ledger::create(const std::string& folder, const std::string& school_name, const SigningKey& key) {
  const LedgerPlaces places{folder};
  if (std::filesystem::exists(places.database())) throw Error(folder, "holds a ledger already", "choose another folder");
  std::error_code ignored;
  std::filesystem::create_directories(folder + "/sessions", ignored);
  // complete under another name first: a process killed here leaves no half a ledger
  const std::string fresh = places.database() + ".new";
  for (const char* end : {"", "-wal", "-shm"}) std::filesystem::remove(fresh + end, ignored);
  {
    Database db = open_for_adding(fresh, true);
    db.run(("PRAGMA application_id = " + std::to_string(k_ledger_application_id)).c_str());
    migrate(db, fresh);
    const std::string id = random_hex(16);
    LedgerContent none;
    const LedgerEntry e = make_entry(0, "init", {{"ledger", id}, {"public_key", to_hex(key.public_key)}, {"school", school_name}});
    Checkpoint p{1, merkle_root(std::span(&e.leaf, 1)), e.utc_ns, {}};
    p.signature = key.sign(checkpoint_message(id, p));
    {
      Transaction all(db);
      insert(db, e, p);
      all.commit();
    }
    db.run("PRAGMA journal_mode = DELETE");  // one file, to be renamed whole
    db.close();
    tell_witness(id, p);
  }
  std::filesystem::rename(fresh, places.database());
}

Ledger::Ledger(const std::string& folder, const SigningKey& key)
    : places_{folder}, key_(key), database_(open_for_adding(LedgerPlaces{folder}.database(), false)) {
  if (database_.integer("PRAGMA application_id") != k_ledger_application_id)
    throw Error(places_.database(), "is no ledger", "name the folder of one");
  migrate(database_, places_.database());
  reload();
}

void Ledger::reload() {
  content_ = read_content(database_, places_.database());
  if (!content_.findings.empty())
    throw Error(places_.folder, "nothing is added to a ledger that does not hold (" + content_.findings.front() + ")",
                "see `cavum ledger verify " + places_.folder + "`, and go back to the copy that holds");
  if (content_.public_key != to_hex(key_.public_key))
    throw Error(places_.folder, "belongs to another school's key", "name that key's file with --key, or restore it");
}

void Ledger::refresh() {
  if (static_cast<std::uint64_t>(database_.integer("SELECT count(*) FROM entry")) != content_.entries.size()) reload();
}

const LedgerEntry& Ledger::append(const std::string& kind, const std::function<json(const LedgerContent&)>& body) {
  Transaction all(database_);
  refresh();
  LedgerEntry e = make_entry(content_.entries.size(), kind, body(content_));
  auto leaves = leaves_of(content_);
  leaves.push_back(e.leaf);
  Checkpoint p{leaves.size(), merkle_root(leaves), e.utc_ns, {}};
  p.signature = key_.sign(checkpoint_message(content_.id, p));
  insert(database_, e, p);
  all.commit();
  content_.entries.push_back(std::move(e));
  content_.checkpoints.push_back(p);
  tell_witness(content_.id, p);
  return content_.entries.back();
}

json Ledger::receipt(std::uint64_t seq) const {
  const auto leaves = leaves_of(content_);
  const Checkpoint& p = content_.checkpoints.back();
  json path = json::array();
  for (const auto& h : inclusion_proof(leaves, seq)) path.push_back(to_hex(h));
  return {{"ledger", content_.id},
          {"public_key", content_.public_key},
          {"entry", content_.entries.at(seq).text},
          {"seq", seq},
          {"inclusion", path},
          {"checkpoint",
           {{"size", p.size}, {"root", to_hex(p.root)}, {"utc", utc_text(p.utc_ns)}, {"utc_ns", p.utc_ns}, {"signature", to_hex(p.signature)}}}};
}

std::vector<std::string> check_receipt(const json& receipt, const std::string& public_key, const LedgerContent* ledger) {
  std::vector<std::string> findings;
  try {
    const std::string id = receipt.at("ledger"), key = receipt.at("public_key"), entry = receipt.at("entry");
    const json& c = receipt.at("checkpoint");
    const Checkpoint p{require_whole<std::uint64_t>(c, "size", "receipt"), fixed_from_hex<32>(c.at("root"), "receipt: root"),
                       require_whole<std::int64_t>(c, "utc_ns", "receipt"), fixed_from_hex<64>(c.at("signature"), "receipt: signature")};
    std::vector<Sha256> path;
    for (const auto& h : receipt.at("inclusion")) path.push_back(fixed_from_hex<32>(h, "receipt: inclusion"));
    if (!public_key.empty() && key != public_key) findings.emplace_back("the receipt is of another school's key");
    if (!is_signed_by(fixed_from_hex<32>(key, "receipt: public_key"), checkpoint_message(id, p), p.signature))
      findings.emplace_back("the school's signature on the receipt does not hold");
    if (!is_included(leaf_hash(bytes_of(entry)), require_whole<std::uint64_t>(receipt, "seq", "receipt"), p.size, path, p.root))
      findings.emplace_back("the entry on the receipt is not the one that the school signed");
    if (ledger != nullptr) {
      if (ledger->id != id) {
        findings.emplace_back("the receipt is of another ledger");
      } else if (ledger->entries.size() < p.size) {
        findings.push_back("the ledger was put back to an older copy: it has " + std::to_string(ledger->entries.size()) +
                           " entries, the receipt saw " + std::to_string(p.size));
      } else {
        std::vector<Sha256> leaves;
        for (const auto& e : ledger->entries) leaves.push_back(leaf_hash(bytes_of(e.text)));
        const Sha256 root = merkle_root(leaves);
        if (!is_consistent(p.size, p.root, leaves.size(), root, consistency_proof(leaves, p.size)))
          findings.emplace_back("the ledger no longer begins with what the receipt saw: history was rewritten");
      }
    }
  } catch (const std::exception& e) {
    findings.push_back(std::string("is no receipt: ") + e.what());
  }
  return findings;
}

}  // namespace cavum
