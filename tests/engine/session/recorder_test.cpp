#include "engine/session/recorder.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <set>
#include <thread>

#include "engine/base/error.h"
#include "engine/base/file.h"
#include "engine/base/file_error.h"
#include "engine/session/resume.h"
#include "engine/session/session_error.h"
#include "engine/session/session_reader.h"
#include "engine/session/verify.h"
#include "tests/engine/session/fixture.h"

namespace cavum {
namespace {

using test::Folder;
using testing_basics::code_of;

TEST(Session, ReadsBackEverythingThatWasRecorded) {
  const Folder folder;
  const std::string path = folder.file("exam.cavum");
  const SessionSetup setup = test::block_setup();
  Simulation simulation = make_simulation(setup, "test");
  std::vector<TickInput> inputs;
  std::vector<TickRecord> records;
  std::vector<RemovedAt> removed;
  const std::string result = R"({"verdict":"fail"})";
  Bytes tooth;
  {
    Recorder recorder = Recorder::create(path, setup);
    for (std::int64_t tick = 0; tick < 3300; ++tick) {
      inputs.push_back(test::motion_at(tick));
      records.push_back(make_tick_record(step(simulation.model, simulation.state, inputs.back())));
      for (const auto& leaf : simulation.state.removed) removed.push_back({tick, leaf});
      if (tick == 1234) recorder.add_event(tick, StepCompleted{2});
      recorder.append(inputs.back(), records.back(), simulation.state.removed,
                      state_hash(simulation.state));
    }
    tooth = save_tooth(drilled_tooth(simulation));
    recorder.close(tooth, result);
    EXPECT_EQ(recorder.ticks_on_disk(), 3300);
  }
  EXPECT_GT(removed.size(), 1000u) << "the motion must drill, or the test shows nothing";
  EXPECT_FALSE(std::filesystem::exists(path + "-wal"));

  const SessionReader session(path);
  session.require_readable();
  EXPECT_TRUE(session.closed());
  EXPECT_EQ(session.inputs(), inputs);
  EXPECT_EQ(session.records(), records);
  const auto read = session.removed();
  ASSERT_EQ(read.size(), removed.size());
  for (std::size_t i = 0; i < read.size(); ++i)
    ASSERT_TRUE(read[i].tick == removed[i].tick && read[i].leaf == removed[i].leaf) << i;
  EXPECT_EQ(session.chunks().size(), 4u);
  EXPECT_EQ(session.chunks().back().ticks, 300);
  EXPECT_EQ(session.events(), (std::vector<TimedEvent>{{1234, StepCompleted{2}}}));
  EXPECT_EQ(session.result_json(), result);
  EXPECT_EQ(session.final_tooth(), tooth);
  const SessionSetup kept = session.setup();
  EXPECT_EQ(kept.candidate, setup.candidate);
  EXPECT_EQ(kept.calibration, setup.calibration);
  EXPECT_EQ(kept.scenario_toml, setup.scenario_toml);
  EXPECT_EQ(kept.rubric_toml, "");
  EXPECT_EQ(kept.burs_toml, setup.burs_toml);
  EXPECT_EQ(kept.force_model_toml, setup.force_model_toml);
  EXPECT_EQ(kept.servo_toml, setup.servo_toml);
  EXPECT_EQ(kept.tooth, setup.tooth);
  EXPECT_EQ(kept.first_tip_nm, setup.first_tip_nm);
  EXPECT_EQ(kept.notes, setup.notes);
  EXPECT_EQ(kept.attachments, setup.attachments);
}

TEST(Session, WhatAKilledBeginningLeftBehindGoesWithTheNextOne) {
  const Folder folder;
  const std::string path = folder.file("exam.cavum");
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  ASSERT_EQ(::waitpid(child, nullptr, 0), child);  // nobody has this number any more
  const std::string dead = std::to_string(child), alive = std::to_string(::getppid());
  for (const std::string& name :
       {path + ".new-" + dead, path + ".new-" + dead + "-journal", path + ".new-" + alive,
        path + ".new-x", path + ".new-" + dead + ".bak", folder.file("other.cavum.new-" + dead)})
    write_text_file(name, "half a session");
  static_cast<void>(Recorder::create(path, test::block_setup()));
  std::set<std::string> left;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    const std::string name = entry.path().filename().string();
    if (name.find(".new-") != std::string::npos) left.insert(name);
  }
  EXPECT_EQ(left,
            (std::set<std::string>{"exam.cavum.new-" + alive, "exam.cavum.new-x",
                                   "exam.cavum.new-" + dead + ".bak", "other.cavum.new-" + dead}));
}

TEST(Session, ReplaysBitForBit) {
  const Folder folder;
  const std::string path = folder.file("exam.cavum");
  test::make_closed_session(path, 4200);
  const VerifyReport report = verify_session(path);
  EXPECT_TRUE(report.verified) << testing_basics::text_of(report.findings);
  EXPECT_TRUE(report.closed);
  EXPECT_TRUE(report.findings.empty());
  EXPECT_EQ(report.ticks, 4200);
  EXPECT_EQ(report.ticks_replayed, 4200);
  EXPECT_FALSE(report.first_divergence);
  EXPECT_EQ(report.station_key, to_hex(load_station_key(station_key_path()).public_key));
}

TEST(Session, ReadingAndVerifyingChangeNothingOnDisk) {
  const Folder folder;
  const std::string path = folder.file("exam.cavum");
  test::make_closed_session(path, 1500);
  const Bytes before = read_file(path);
  const auto written = std::filesystem::last_write_time(path);
  (void)verify_session(path);
  EXPECT_EQ(read_file(path), before);
  EXPECT_EQ(std::filesystem::last_write_time(path), written);
  for (const char* suffix : {"-wal", "-shm", "-journal"})
    EXPECT_FALSE(std::filesystem::exists(path + suffix)) << suffix;
}

TEST(Session, CanBeReadWhileItIsRecorded) {
  const Folder folder;
  const std::string path = folder.file("exam.cavum");
  const SessionSetup setup = test::block_setup();
  Simulation simulation = make_simulation(setup, "test");
  Recorder recorder = Recorder::create(path, setup);
  test::drill(simulation, recorder, 0, 2500);
  const Bytes before = read_file(path), log = read_file(path + "-wal");
  const VerifyReport report = verify_session(path);
  EXPECT_EQ(report.ticks, 2000);
  EXPECT_FALSE(report.closed);
  EXPECT_FALSE(report.verified) << "without its seal, an end that was cut off could not be told";
  EXPECT_TRUE(report.intact);
  EXPECT_EQ(report.findings.size(), 1u);
  EXPECT_EQ(read_file(path), before);
  EXPECT_EQ(read_file(path + "-wal"), log);
  recorder.flush();
  EXPECT_EQ(SessionReader(path).ticks(), 2500);
}

TEST(Session, NeverOverwritesAnExistingFile) {
  const Folder folder;
  const std::string path = folder.file("exam.cavum");
  write_text_file(path, "mine");
  EXPECT_EQ(code_of([&] { (void)Recorder::create(path, test::block_setup()); }), FileError::exists);
  EXPECT_EQ(read_text_file(path), "mine");
}

TEST(Session, RefusesWhatItCannotRecord) {
  const Folder folder;
  EXPECT_THROW((void)Recorder::create(folder.file("no/such/folder.cavum"), test::block_setup()),
               Error);
  SessionSetup setup = test::block_setup();
  setup.tooth.clear();
  EXPECT_EQ(code_of([&] { (void)Recorder::create(folder.file("a.cavum"), setup); }),
            FileError::missing);
  Recorder recorder = Recorder::create(folder.file("b.cavum"), test::block_setup());
  TickRecord record;
  record.removed = 2;
  EXPECT_EQ(code_of([&] { recorder.append({}, record, {}, 0); }), FileError::inconsistent);
  EXPECT_EQ(recorder.ticks(), 0);
}

TEST(Session, EndedWithoutClosingResumesAndVerifies) {
  const Folder folder;
  const std::string path = folder.file("exam.cavum");
  const SessionSetup setup = test::block_setup();
  {
    Simulation simulation = make_simulation(setup, "test");
    Recorder recorder = Recorder::create(path, setup);
    test::drill(simulation, recorder, 0, 2300);
  }  // the exam fell over; the recorder wrote what it had
  std::int64_t visited = 0;
  ResumedSession exam = resume_session(
      path, [&](std::int64_t tick, const TickInput& input, const TickOutput&, const ServoState&) {
        EXPECT_EQ(tick, visited++);
        EXPECT_EQ(input, test::motion_at(tick));
      });
  EXPECT_EQ(visited, 2300);
  EXPECT_EQ(exam.ticks, 2300);
  EXPECT_THROW((void)resume_session(path), DatabaseError) << "it is held";
  test::drill(exam.simulation, exam.recorder, exam.ticks, 1900);
  exam.recorder.close(save_tooth(drilled_tooth(exam.simulation)), "{}");

  const VerifyReport report = verify_session(path);
  EXPECT_TRUE(report.verified) << testing_basics::text_of(report.findings);
  EXPECT_EQ(report.ticks, 4200);
  const auto events = SessionReader(path).events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].tick, 2300);
  ASSERT_NE(events[0].as<RecordingGap>(), nullptr);
  EXPECT_GE(events[0].as<RecordingGap>()->boot_s.value(), 0.0);
  EXPECT_EQ(code_of([&] { (void)resume_session(path); }), SessionError::closed);
}

TEST(Session, ResumedBeforeItsFirstSecondStillVerifies) {
  const Folder folder;
  const std::string path = folder.file("exam.cavum");
  { Recorder recorder = Recorder::create(path, test::block_setup()); }
  ResumedSession exam = resume_session(path);
  EXPECT_EQ(exam.ticks, 0);
  test::drill(exam.simulation, exam.recorder, 0, 700);
  exam.recorder.close(save_tooth(drilled_tooth(exam.simulation)), "{}");
  EXPECT_TRUE(verify_session(path).verified);
}

TEST(Session, FilesThatAreNoSessionAreErrorsNotReports) {
  const Folder folder;
  EXPECT_THROW((void)verify_session(folder.file("missing.cavum")), Error);
  EXPECT_THROW((void)verify_session(folder.file("")), Error) << "a folder";
  write_text_file(folder.file("empty.cavum"), "");
  EXPECT_THROW((void)verify_session(folder.file("empty.cavum")), Error);
  write_text_file(folder.file("text.cavum"), std::string(5000, 'x'));
  EXPECT_THROW((void)verify_session(folder.file("text.cavum")), Error);
  {
    Database other = Database::open(folder.file("other.cavum"), true);
    other.run("CREATE TABLE music (title TEXT); INSERT INTO music VALUES ('x')");
  }
  EXPECT_EQ(code_of([&] { (void)verify_session(folder.file("other.cavum")); }),
            SessionError::not_a_session);
}

TEST(StationKey, IsMadeOnceForItsUserAlone) {
  const Folder folder;
  const std::string path = folder.file("home/station.key");
  const SigningKey first = load_station_key(path), again = load_station_key(path);
  EXPECT_EQ(first.public_key, again.public_key);
  EXPECT_NE(first.public_key, load_station_key(folder.file("other/station.key")).public_key);
  EXPECT_EQ(std::filesystem::status(path).permissions(),
            std::filesystem::perms::owner_read | std::filesystem::perms::owner_write);
  const Bytes message{1, 2, 3};
  EXPECT_TRUE(is_signed_by(first.public_key, message, first.sign(message)));
  EXPECT_FALSE(is_signed_by(first.public_key, Bytes{1, 2, 4}, first.sign(message)));
  std::filesystem::permissions(path, std::filesystem::perms::group_read,
                               std::filesystem::perm_options::add);
  EXPECT_THROW((void)load_station_key(path), Error);
  std::filesystem::permissions(path, std::filesystem::perms::group_read,
                               std::filesystem::perm_options::remove);
  std::filesystem::resize_file(path, 20);
  EXPECT_THROW((void)load_station_key(path), Error);
}

TEST(StationKey, MadeByManyAtOnceIsOne) {
  const Folder folder;
  const std::string path = folder.file("home/station.key");
  std::vector<SigningKey> keys(16);
  std::vector<std::thread> threads;
  for (auto& key : keys) threads.emplace_back([&key, &path] { key = load_station_key(path); });
  for (auto& t : threads) t.join();
  for (const auto& key : keys) EXPECT_EQ(key.public_key, keys[0].public_key);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.file("home")),
                          std::filesystem::directory_iterator()),
            1)
      << "nothing is left over";
}

}  // namespace
}  // namespace cavum
