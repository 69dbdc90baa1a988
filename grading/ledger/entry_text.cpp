#include "grading/ledger/entry_text.h"

#include <fmt/core.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <concepts>
#include <set>
#include <type_traits>

#include "engine/base/error.h"
#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/message_json.h"
#include "engine/base/text.h"
#include "engine/session/session.h"
#include "grading/ledger/ledger_key.h"

namespace cavum::ledger {
namespace {

using nlohmann::json;

constexpr std::size_t k_longest_text = 1U << 20, k_longest_list = 1'000'000;

/// Of the kinds, in the order of Entry.
constexpr std::array<const char*, std::variant_size_v<Entry>> k_kinds = {
    "init",  "ticket",   "cancel", "begin",    "session", "regrade", "release", "retract", "appeal", "answer", "announce", "hold",
    "go_on", "incident", "seats",  "passback", "erase",   "forget",  "key",     "restore", "invite", "enrol",  "revoke",   "room"};
static_assert(k_kinds.back() != nullptr, "each kind has a name");

/// Of an enum's values, in their order.
template <class Enum>
constexpr std::array<const char*, 0> k_words{};
template <>
constexpr std::array k_words<Part> = {said("motion"), said("result"), said("sealed"), said("words")};
template <>
constexpr std::array k_words<FirstSitting> = {said("missed"), said("interrupted")};
template <>
constexpr std::array k_words<Outcome> = {said("stands"), said("changed")};
template <>
constexpr std::array k_words<SourceKind> = k_source_kinds;

template <class E, class Kind>
concept Is = std::same_as<std::remove_const_t<E>, Kind>;

// What each struct has, for whoever writes, reads or looks for openings. `may`: absent where it is empty.

void fields(auto& io, Is<Actor> auto& e) {
  io.may("account", e.account);
  io.may("reason", e.reason);
  io.may("station", e.station);
}
void fields(auto& io, Is<InitEntry> auto& e) {
  io("ledger", e.ledger);
  io("public_key", e.public_key);
  io("school", e.school);
}
void fields(auto& io, Is<Ticket> auto& t) {
  io.format("cavum ticket 1");
  io("artifacts", t.artifacts);
  io("begun_at_ledger", t.begun_at_ledger);
  io("candidate", t.candidate);
  io("exam", t.exam);
  io("grant_sha256", t.grant_sha256);
  io("ledger", t.ledger);
  io("nonce", t.nonce);
  io.utc("not_after", t.not_after_utc_ns);
  io.utc("not_before", t.not_before_utc_ns);
  io("public_key", t.public_key);
}
void fields(auto& io, Is<MakesUp> auto& e) {
  io("became", e.became);
  io("ticket", e.ticket);
}
void fields(auto& io, Is<TicketEntry> auto& e) {
  io("signature", e.signature);
  io("ticket", e.ticket);
  io.may("makes_up", e.makes_up);
}
void fields(auto& io, Is<CancelEntry> auto& e) { io("ticket", e.ticket); }
void fields(auto& io, Is<Begin> auto& b) {
  io.format("cavum begin 1");
  io("ledger", b.ledger);
  io("nonce", b.nonce);
  io("public_key", b.public_key);
  io("ticket", b.ticket);
  io("utc_ns", b.utc_ns);
}
void fields(auto& io, Is<BeginEntry> auto& e) {
  io("begin", e.begin);
  io("signature", e.signature);
  io.may("again", e.again);
}
void fields(auto& io, Is<MotionSource> auto& s) {
  io("kind", s.kind);
  io("name", s.name);
  io("serial", s.serial);
}
void fields(auto& io, Is<SessionEntry> auto& e) {
  io("begun_utc_ns", e.begun_utc_ns);
  io("candidate", e.candidate);
  io("chain_sha256", e.chain_sha256);
  io("closed_utc_ns", e.closed_utc_ns);
  io("file_sha256", e.file_sha256);
  io("findings", e.findings);
  io("grading_version", e.grading_version);
  io("nonce", e.nonce);
  io("physics_version", e.physics_version);
  io("scenario_id", e.scenario_id);
  io("simulated", e.simulated);
  io("source", e.source);
  io("station_key", e.station_key);
  io("ticks", e.ticks);
  io.opens(Part::result, e.result);
  io.opens(Part::sealed, e.sealed);
}
void fields(auto& io, Is<RegradeEntry> auto& e) {
  io("by", e.by);
  io("session", e.session);
  io.may("person", e.person);
  io.opens(Part::result, e.result);
}
void fields(auto& io, Is<ReleaseEntry> auto& e) { io("results", e.results); }
void fields(auto& io, Is<RetractEntry> auto& e) { io("results", e.results); }
void fields(auto& io, Is<AppealEntry> auto& e) { io("session", e.session); }
void fields(auto& io, Is<AnswerEntry> auto& e) {
  io("answers", e.answers);
  io("outcome", e.outcome);
  io("session", e.session);
}
void fields(auto& io, Is<Audience> auto& a) {
  io.may("room", a.room);
  io.may("stations", a.stations);
}
void fields(auto& io, Is<AnnounceEntry> auto& e) {
  io("text", e.text);
  fields(io, e.audience);
}
void fields(auto& io, Is<HoldEntry> auto& e) { fields(io, e.audience); }
void fields(auto& io, Is<GoOnEntry> auto& e) { io("hold", e.hold); }
void fields(auto& io, Is<IncidentEntry> auto& e) {
  io.may("about_station", e.about_station);
  io.may("candidate", e.candidate);
  io.opens(Part::words, e.words);
}
void fields(auto& io, Is<Seat> auto& s) {
  io("station", s.station);
  io("ticket", s.ticket);
}
void fields(auto& io, Is<SeatsEntry> auto& e) { io("seats", e.seats); }
void fields(auto& io, Is<PassbackEntry> auto& e) {
  io("answer", e.answer);
  io("line_item", e.line_item);
  io("platform", e.platform);
  io("result", e.result);
  io("session", e.session);
  io("status", e.status);
}
void fields(auto& io, Is<ErasedPart> auto& p) {
  io("entry", p.entry);
  io("what", p.what);
}
void fields(auto& io, Is<EraseEntry> auto& e) { io("erased", e.erased); }
void fields(auto& io, Is<ForgetEntry> auto& e) {
  io("candidate", e.candidate);
  io.may("erased", e.erased);
}
void fields(auto& io, Is<KeyEntry> auto& e) {
  io("public_key", e.public_key);
  io("signature", e.signature);
  io("until_utc_ns", e.until_utc_ns);
}
void fields(auto& io, Is<SizeAndRoot> auto& s) {
  io("root", s.root);
  io("size", s.size);
}
void fields(auto& io, Is<RestoreEntry> auto& e) {
  io("backup", e.backup);
  io("lost", e.lost);
  io("missing_sessions", e.missing_sessions);
}
void fields(auto& io, Is<InviteEntry> auto& e) {
  io("code_key", e.code_key);
  io("name", e.name);
  io("until_utc_ns", e.until_utc_ns);
}
void fields(auto& io, Is<Stylus> auto& s) {
  io("name", s.name);
  io("serial", s.serial);
}
void fields(auto& io, Is<StationRequest> auto& r) {
  io.format("cavum station request 1");
  io("by", r.by);
  io("devices", r.devices);
  io("made_utc_ns", r.made_utc_ns);
  io("public_key", r.public_key);
  io("school", r.school);
}
void fields(auto& io, Is<SignedRequest> auto& r) {
  io("request", r.request);
  io("signature", r.signature);
  io.may("code_signature", r.code_signature);
  io.may("old_signature", r.old_signature);
}
void fields(auto& io, Is<EnrolEntry> auto& e) {
  io("asked", e.asked);
  io("until_utc_ns", e.until_utc_ns);
}
void fields(auto& io, Is<RevokeEntry> auto& e) { io("public_key", e.public_key); }
void fields(auto& io, Is<RoomEntry> auto& e) {
  io("public_key", e.public_key);
  io("room", e.room);
}

[[noreturn]] void no_entry(const std::string& where, const Message& what) { throw Error(where, what, msg("use an intact copy")); }

class EntryWriter {
 public:
  json out = json::object();

  template <class T>
  void operator()(const char* name, const T& value) {
    out[name] = put(value);
  }
  template <class T>
  void may(const char* name, const T& value) {
    if (value != T()) out[name] = put(value);
  }
  template <class T>
  void may(const char* name, const std::optional<T>& value) {
    if (value) out[name] = put(*value);
  }
  template <class T>
  void may(const char* name, const std::vector<T>& value) {
    if (!value.empty()) out[name] = put(value);
  }
  void format(const char* text) { out["format"] = text; }
  void utc(const char* name, std::int64_t utc_ns) { out[name] = utc_text(utc_ns); }
  void opens(Part what, const Opening& o) { out["opens"][word_of(what)] = o.sha256; }
  void opens(Part what, const std::optional<Opening>& o) {
    if (o) opens(what, *o);
  }

 private:
  template <class T>
  static json put(const T& value) {
    if constexpr (std::is_enum_v<T>) {
      return word_of(value);
    } else if constexpr (std::same_as<T, Sha256>) {
      return to_hex(value);
    } else if constexpr (std::same_as<T, std::vector<Message>>) {
      return encode(value);
    } else if constexpr (std::constructible_from<json, const T&>) {
      return value;
    } else {
      EntryWriter inside;
      fields(inside, value);
      return std::move(inside.out);
    }
  }
  template <class T>
  requires(!std::constructible_from<json, const T&>) static json put(const std::vector<T>& list) {
    json all = json::array();
    for (const T& one : list) all.push_back(put(one));
    return all;
  }
};

/// Of one object: what is missing, of another type or too long is an Error, and so is what nobody asked for.
class EntryReader {
 public:
  EntryReader(const json& j, std::string where) : j_(j), where_(std::move(where)) {
    if (!j.is_object()) no_entry(where_, msg("is no JSON object"));
  }
  template <class T>
  void operator()(const char* name, T& value) {
    asked_.insert(name);
    const auto found = j_.find(name);
    if (found == j_.end()) no_entry(where_, msg("has no '{}'", name));
    take(*found, fmt::format("{}: {}", where_, name), value);
  }
  template <class T>
  void may(const char* name, T& value) {
    asked_.insert(name);
    if (j_.contains(name)) (*this)(name, value);
  }
  void format(const char* text) {
    std::string is;
    (*this)("format", is);
    if (is != text) throw Error(where_, msg("is no '{}'", text), msg("use the version of Cavum that wrote it"));
  }
  void utc(const char* name, std::int64_t& utc_ns) {
    std::string text;
    (*this)(name, text);
    utc_ns = parse_utc(text, fmt::format("{}: {}", where_, name));
  }
  void opens(Part what, Opening& o) {
    asked_.insert("opens");
    const auto all = j_.find("opens");
    if (all == j_.end() || !all->is_object() || !all->contains(word_of(what))) no_entry(where_, msg("opens no '{}'", word_of(what)));
    std::string hash;
    take(all->at(word_of(what)), where_ + ": opens", hash);
    o.sha256 = to_hex(fixed_from_hex<32>(hash, where_ + ": opens"));
    ++opened_;
  }
  void opens(Part what, std::optional<Opening>& o) {
    if (const auto all = j_.find("opens"); all != j_.end() && all->contains(word_of(what))) opens(what, o.emplace());
  }
  void done() const {
    for (const auto& [name, value] : j_.items())
      if (!asked_.contains(name)) no_entry(where_, msg("has a member that it should not have: '{}'", one_line(name.substr(0, 80))));
    if (const auto all = j_.find("opens"); all != j_.end() && all->size() != opened_) no_entry(where_, msg("opens what its kind does not have"));
  }

 private:
  static void take(const json& j, const std::string& where, std::string& value) {
    if (!j.is_string()) no_entry(where, msg("is no text"));
    value = j.get<std::string>();
    if (value.size() > k_longest_text) no_entry(where, msg("is longer than {} bytes", k_longest_text));
  }
  static void take(const json& j, const std::string& where, bool& value) {
    if (!j.is_boolean()) no_entry(where, msg("is neither true nor false"));
    value = j.get<bool>();
  }
  template <std::integral Whole>
  static void take(const json& j, const std::string& where, Whole& value) {
    const bool fits =
        j.is_number_unsigned() ? std::in_range<Whole>(j.get<std::uint64_t>()) : j.is_number_integer() && std::in_range<Whole>(j.get<std::int64_t>());
    if (!fits) no_entry(where, msg("is no whole number in its range"));
    value = j.get<Whole>();
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  static void take(const json& j, const std::string& where, Enum& value) {
    std::string word;
    take(j, where, word);
    value = of_word<Enum>(word, where);
  }
  static void take(const json& j, const std::string& where, Sha256& value) {
    std::string hex;
    take(j, where, hex);
    value = fixed_from_hex<32>(hex, where);
  }
  static void take(const json& j, const std::string& where, std::vector<Message>& value) {
    try {
      value = decode_messages(j);
    } catch (const std::invalid_argument& e) {
      no_entry(where, msg("is no list of messages: {}", e.what()));
    }
  }
  static void take(const json& j, const std::string& where, std::map<std::string, std::string>& value) {
    if (!j.is_object()) no_entry(where, msg("is no JSON object"));
    for (const auto& [name, text] : j.items()) take(text, where, value[name]);
  }
  template <class T>
  static void take(const json& j, const std::string& where, std::vector<T>& list) {
    if (!j.is_array() || j.size() > k_longest_list) no_entry(where, msg("is no list of at most {}", k_longest_list));
    for (const json& one : j) take(one, where, list.emplace_back());
  }
  template <class T>
  static void take(const json& j, const std::string& where, std::optional<T>& value) {
    take(j, where, value.emplace());
  }
  template <class T>
  requires std::is_class_v<T>
  static void take(const json& j, const std::string& where, T& value) {
    EntryReader inside(j, where);
    fields(inside, value);
    inside.done();
  }

  template <class T>
  friend T ledger::value_in(const json& j, const std::string& where);

  const json& j_;
  std::string where_;
  std::set<std::string> asked_;
  std::size_t opened_ = 0;
};

class EntryOpenings {
 public:
  std::map<Part, Opening*> out;

  template <class T>
  void operator()(const char*, const T&) {}
  template <class T>
  void may(const char*, const T&) {}
  void opens(Part what, Opening& o) { out[what] = &o; }
  void opens(Part what, std::optional<Opening>& o) {
    if (o) out[what] = &*o;
  }
};

/// Nothing is said in it yet.
Entry entry_of_kind(const std::string& kind, const std::string& where) {
  Entry out;
  const auto at = std::find(k_kinds.begin(), k_kinds.end(), kind);
  if (at == k_kinds.end()) no_entry(where, msg("is of a kind that this version does not know: '{}'", one_line(kind.substr(0, 80))));
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    ((I == static_cast<std::size_t>(at - k_kinds.begin()) ? static_cast<void>(out.emplace<I>()) : void()), ...);
  }
  (std::make_index_sequence<k_kinds.size()>());
  return out;
}

}  // namespace

std::string entry_text(const LedgerEntry& e) {
  EntryWriter body;
  fields(body, e.by);
  std::visit([&](const auto& what) { fields(body, what); }, e.what.value());
  return json{{"body", body.out}, {"kind", kind_name(*e.what)}, {"seq", e.seq}, {"utc_ns", e.utc_ns}}.dump();
}

LedgerEntry read_entry(const std::string& text, const std::string& where) {
  LedgerEntry e;
  const json j = parse_json(text, where);
  EntryReader all(j, where);
  std::string kind;
  all("kind", kind);
  all("seq", e.seq);
  all("utc_ns", e.utc_ns);
  e.what = entry_of_kind(kind, where);
  EntryReader body(member_of(j, "body"), where);
  fields(body, e.by);
  std::visit([&](auto& what) { fields(body, what); }, *e.what);
  body.done();
  e.text = text;
  return e;
}

LedgerEntry read_entry_or_none(const std::string& text) noexcept {
  try {
    return read_entry(text, "entry");
  } catch (const std::exception&) {
    return {};
  }
}

const char* kind_name(const Entry& entry) { return k_kinds[entry.index()]; }

std::map<Part, Opening*> openings_of(Entry& entry) {
  EntryOpenings found;
  std::visit([&](auto& what) { fields(found, what); }, entry);
  return found.out;
}

std::map<Part, const Opening*> openings_of(const Entry& entry) {
  const auto found = openings_of(const_cast<Entry&>(entry));
  return {found.begin(), found.end()};
}

template <class Value>
json json_of(const Value& value) {
  EntryWriter io;
  fields(io, value);
  return std::move(io.out);
}

template <class Value>
Value value_in(const json& j, const std::string& where) {
  Value value;
  EntryReader::take(j, where, value);
  return value;
}

template <class Enum>
const char* word_of(Enum value) {
  return k_words<Enum>[static_cast<std::size_t>(value)];
}

template <class Enum>
Enum of_word(const std::string& word, const std::string& where) {
  const auto at = std::find(k_words<Enum>.begin(), k_words<Enum>.end(), word);
  if (at == k_words<Enum>.end())
    throw Error(where, msg("'{}' is none of its words", one_line(word.substr(0, 80))), msg("say {}", list_of(k_words<Enum>)));
  return static_cast<Enum>(at - k_words<Enum>.begin());
}

template json json_of(const Ticket&);
template json json_of(const Begin&);
template json json_of(const StationRequest&);
template json json_of(const SignedRequest&);
template Ticket value_in(const json&, const std::string&);
template Begin value_in(const json&, const std::string&);
template SignedRequest value_in(const json&, const std::string&);
template const char* word_of(Part);
template const char* word_of(FirstSitting);
template const char* word_of(Outcome);
template FirstSitting of_word(const std::string&, const std::string&);
template Outcome of_word(const std::string&, const std::string&);

}  // namespace cavum::ledger
