#include "grading/records/entry_text.h"

#include <algorithm>
#include <array>

#include "engine/base/json_fields.h"
#include "engine/base/json_reader.h"
#include "engine/base/json_struct.h"
#include "engine/base/text.h"
#include "engine/session/session.h"
#include "engine/session/source_json.h"
#include "grading/records/ledger_key.h"

namespace cavum::records {

using nlohmann::json;

constexpr auto names_of(Part) {
  return std::array{noop("motion"), noop("result"), noop("sealed"), noop("words")};
}
constexpr auto names_of(FirstSitting) { return std::array{noop("missed"), noop("interrupted")}; }
constexpr auto names_of(Outcome) { return std::array{noop("stands"), noop("changed")}; }

/// A time as text, bytes as hexadecimal digits, and an opening as its hash.
template <class Ns>
struct AsUtc {
  Ns& ns;
};
template <class Bytes>
struct AsHex {
  Bytes& bytes;
};
template <class Ns>
AsUtc<Ns> as_utc(Ns& ns) {
  return {ns};
}
template <class Bytes>
AsHex<Bytes> as_hex(Bytes& bytes) {
  return {bytes};
}
json write_json(const AsUtc<const std::int64_t>& t) { return utc_text(t.ns); }
void read_json(const json& from, const JsonLocation& at, const AsUtc<std::int64_t>& t) {
  std::string text;
  read_json_value(from, at, text);
  t.ns = parse_utc(text, at.text());
}
json write_json(const AsHex<const Sha256>& hash) { return to_hex(hash.bytes); }
void read_json(const json& from, const JsonLocation& at, const AsHex<Sha256>& hash) {
  std::string text;
  read_json_value(from, at, text);
  hash.bytes = fixed_from_hex<sizeof(Sha256)>(text, at.text());
}
json write_json(const Opening& o) { return o.sha256; }
void read_json(const json& from, const JsonLocation& at, Opening& o) {
  Sha256 hash{};
  read_json(from, at, as_hex(hash));
  o.sha256 = to_hex(hash);
}

// clang-format off
// What each struct has, for whoever writes, reads or looks for openings.

CAVUM_JSON_OF(Actor, (account, sparse), (reason, sparse), (station, sparse))
CAVUM_JSON_OF(InitEntry, (ledger), (public_key), (school))
void json_fields(auto& of, JsonOf<Ticket> auto& self) {
  of("format", JsonFormat{"cavum ticket 1"});
  CAVUM_NAMES((artifacts), (begun_at_ledger), (candidate), (exam), (grant_sha256), (ledger), (nonce), (public_key))
  of("not_after", as_utc(self.not_after_utc_ns)), of("not_before", as_utc(self.not_before_utc_ns));
}
CAVUM_JSON_OF(MakesUp, (became), (ticket))
CAVUM_JSON_OF(TicketEntry, (signature), (ticket), (makes_up))
CAVUM_JSON_OF(CancelEntry, (ticket))
void json_fields(auto& of, JsonOf<Begin> auto& self) {
  of("format", JsonFormat{"cavum begin 1"});
  CAVUM_NAMES((ledger), (nonce), (public_key), (ticket), (utc_ns))
}
CAVUM_JSON_OF(BeginEntry, (begin), (signature), (again, sparse))
void json_fields(auto& of, JsonOf<SessionEntry> auto& self) {
  CAVUM_NAMES((begun_utc_ns), (candidate), (chain_sha256), (closed_utc_ns), (file_sha256), (findings), (grading_version), (nonce), (physics_version),
              (scenario_id), (simulated), (source), (station_key), (ticks))
  of("opens", json_inside([&](auto& opens) { opens("result", self.result), opens("sealed", self.sealed); }));
}
void json_fields(auto& of, JsonOf<RegradeEntry> auto& self) {
  CAVUM_NAMES((by), (session), (person, sparse))
  of("opens", json_inside([&](auto& opens) { opens("result", self.result); }));
}
CAVUM_JSON_OF(ReleaseEntry, (results))
CAVUM_JSON_OF(RetractEntry, (results))
CAVUM_JSON_OF(AppealEntry, (session))
CAVUM_JSON_OF(AnswerEntry, (answers), (outcome), (session))
CAVUM_JSON_OF(Audience, (room, sparse), (stations, sparse))
void json_fields(auto& of, JsonOf<AnnounceEntry> auto& e) { of("text", e.text), json_fields(of, e.audience); }
void json_fields(auto& of, JsonOf<HoldEntry> auto& e) { json_fields(of, e.audience); }
CAVUM_JSON_OF(GoOnEntry, (hold))
void json_fields(auto& of, JsonOf<IncidentEntry> auto& self) {
  CAVUM_NAMES((about_station, sparse), (candidate, sparse))
  of("opens", json_inside([&](auto& opens) { opens("words", self.words); }));
}
CAVUM_JSON_OF(Seat, (station), (ticket))
CAVUM_JSON_OF(SeatsEntry, (seats))
CAVUM_JSON_OF(PassbackEntry, (answer), (line_item), (platform), (result), (session), (status))
CAVUM_JSON_OF(ErasedPart, (entry), (what))
CAVUM_JSON_OF(EraseEntry, (erased))
CAVUM_JSON_OF(ForgetEntry, (candidate), (erased, sparse))
CAVUM_JSON_OF(KeyEntry, (public_key), (signature), (until_utc_ns))
void json_fields(auto& of, JsonOf<SizeAndRoot> auto& s) { of("root", as_hex(s.root)), of("size", s.size); }
CAVUM_JSON_OF(RestoreEntry, (backup), (lost), (missing_sessions))
CAVUM_JSON_OF(InviteEntry, (code_key), (name), (until_utc_ns))
CAVUM_JSON_OF(Stylus, (name), (serial))
void json_fields(auto& of, JsonOf<StationRequest> auto& self) {
  of("format", JsonFormat{"cavum station request 1"});
  CAVUM_NAMES((by), (devices), (made_utc_ns), (public_key), (school))
}
CAVUM_JSON_OF(SignedRequest, (request), (signature), (code_signature, sparse), (old_signature, sparse))
CAVUM_JSON_OF(EnrolEntry, (asked), (until_utc_ns))
CAVUM_JSON_OF(RevokeEntry, (public_key))
CAVUM_JSON_OF(RoomEntry, (public_key), (room))
// clang-format on

/// All that an entry says beside its number and time.
template <class Of, class Said>
void body_fields(Of& of, Said& e) {
  json_fields(of, e.by);
  std::visit([&](auto& what) { json_fields(of, what); }, *e.what);
}

namespace {

JsonSource source_of(const Where& where) {
  return {where, msg("use an intact copy"), true, 1U << 20, 1'000'000};
}

/// Notes where the openings are.
struct FindOpenings {
  std::map<Part, Opening*>& out;

  void operator()(const char* name, Opening& o) const { out[of_word<Part>(name, name)] = &o; }
  void operator()(const char* name, std::optional<Opening>& o) const {
    if (o) (*this)(name, *o);
  }
  template <class Fields>
  void operator()(const char*, const JsonInside<Fields>& inside) const {
    inside.fields(*this);
  }
  void operator()(const char*, const auto&, JsonField = JsonField::always) const {}
};

/// Nothing is said in it yet.
Entry entry_of_kind(const std::string& kind, const JsonSource& source) {
  Entry out;
  const auto becomes = [&]<std::size_t... I>(std::index_sequence<I...>) {
    return ((kind == std::variant_alternative_t<I, Entry>::k_kind && (out.emplace<I>(), true)) ||
            ...);
  };
  if (!becomes(std::make_index_sequence<std::variant_size_v<Entry>>()))
    JsonLocation{source, "kind"}.refuse(
        msg("is a kind that this version does not know: '{}'", one_line(kind.substr(0, 80))));
  return out;
}

}  // namespace

std::string entry_text(const LedgerEntry& e) {
  const auto body = json_inside([&](auto& of) { body_fields(of, e); });
  return json{{"body", to_json_value(body)},
              {"kind", kind_name(*e.what)},
              {"seq", e.seq},
              {"utc_ns", e.utc_ns}}
      .dump();
}

LedgerEntry read_entry(const std::string& text, const Where& where) {
  LedgerEntry e;
  const JsonSource source = source_of(where);
  std::string kind;
  auto all = json_inside([&](auto& of) {
    of("kind", kind), of("seq", e.seq), of("utc_ns", e.utc_ns);
    of("body", json_inside([&](auto& body) { body_fields(body, e); }));
  });
  const json j = parse_json(text, where);
  e.what = entry_of_kind(text_in(j, "kind"), source);
  read_json_value(j, {source}, all);
  e.text = text;
  return e;
}

LedgerEntry read_entry_or_none(const std::string& text) noexcept {
  try {
    return read_entry(text, msg("entry"));
  } catch (const std::exception&) {
    return {};
  }
}

const char* kind_name(const Entry& entry) {
  return std::visit([](const auto& e) -> const char* { return e.k_kind; }, entry);
}

std::map<Part, Opening*> openings_of(Entry& entry) {
  std::map<Part, Opening*> out;
  const FindOpenings find{out};
  std::visit([&](auto& what) { json_fields(find, what); }, entry);
  return out;
}

std::map<Part, const Opening*> openings_of(const Entry& entry) {
  const auto found = openings_of(const_cast<Entry&>(entry));
  return {found.begin(), found.end()};
}

template <class Value>
json json_of(const Value& value) {
  return to_json_value(value);
}

template <class Value>
Value value_in(const json& j, const Where& where) {
  return json_value_of<Value>(j, source_of(where));
}

template <class Enum>
const char* word_of(Enum value) {
  return names_of(value)[static_cast<std::size_t>(value)];
}

template <class Enum>
Enum of_word(const std::string& word, const Where& where) {
  return json_value_of<Enum>(word, {where, msg("say one of its words")});
}

template json json_of(const Ticket&);
template json json_of(const Begin&);
template json json_of(const StationRequest&);
template json json_of(const SignedRequest&);
template Ticket value_in(const json&, const Where&);
template Begin value_in(const json&, const Where&);
template SignedRequest value_in(const json&, const Where&);
template const char* word_of(Part);
template const char* word_of(FirstSitting);
template const char* word_of(Outcome);
template FirstSitting of_word(const std::string&, const Where&);
template Outcome of_word(const std::string&, const Where&);

}  // namespace cavum::records
