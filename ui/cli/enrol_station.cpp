#include "ui/cli/enrol_station.h"

#include <filesystem>

#include "engine/base/file.h"
#include "engine/device/hardware/stylus_kind.h"
#include "grading/records/ledger_key.h"
#include "grading/records/station_ticket.h"
#include "grading/records/stations.h"
#include "ui/parts/say.h"

namespace cavum::ui {
namespace {

MotionSource stylus(const std::string& id) {
  const StylusKind& kind = stylus_kinds().at(id, Name{"--stylus " + id}, {StylusHand::person});
  return {SourceKind::device, id, kind.serial ? kind.serial(load_station_stylus(kind)) : ""};
}

}  // namespace

void enrol_station(const EnrolOptions& o) {
  if (o.replace_key && !o.code.empty())
    throw Error(Name{"--replace-key"}, msg("was asked for together with --enrol"),
                msg("give one of them"));
  const std::string school = records::station_school_key();
  if (school.empty())
    throw Error(Name{records::school_public_key_path()}, msg("this station knows no school yet"),
                msg("copy the school's public key there: `cavum ledger init` writes it"));
  if (std::filesystem::is_directory(o.out))
    throw Error(Name{"--out " + o.out}, msg("is a folder"),
                msg("name the file to write the request to"));
  require_writable(o.out);
  std::vector<MotionSource> devices;
  for (const auto& id : o.styluses) devices.push_back(stylus(id));
  const std::string path = station_key_path();
  const SigningKey old = load_station_key(path);
  std::string request;
  SigningKey key = old;
  if (o.replace_key) {
    const std::string fresh = path + ".new", kept = path + ".old";
    std::filesystem::remove(fresh);
    key = load_signing_key(fresh, "station");
    request = records::station_request(key, school, devices, old);
    write_text_file(o.out, request + "\n");
    std::filesystem::rename(path, kept);
    std::filesystem::rename(fresh, path);
  } else {
    request = records::station_request(key, school, devices, o.code);
    write_text_file(o.out, request + "\n");
  }
  remember_enrolled(path, key);
  say(msg("this station's key: {}", to_hex(key.public_key)));
  say(msg("bring {} to the school: `cavum ledger station LEDGER --enrol {}`", o.out, o.out));
}

}  // namespace cavum::ui
