// Exams in pieces: what is taken and what is not, that nothing mixes, and a line that breaks in the
// middle.
#include "ui/office/pieces.h"

#include <boost/asio.hpp>

#include "engine/base/hash.h"
#include "engine/session/sqlite.h"
#include "tests/engine/session/fixture.h"
#include "tests/grading/records/short_exam.h"
#include "tests/ui/office/opened.h"

namespace cavum::office {
namespace {

using namespace testing_office;
using namespace testing_ledger;
using nlohmann::json;

const std::string k_one(64, '1'), k_two(64, '2');

std::string some_bytes(std::size_t size, std::uint64_t seed) {
  std::string out(size, '\0');
  for (char& c : out)
    c = static_cast<char>((seed = seed * 6364136223846793005U + 1442695040888963407U) >> 56);
  return out;
}

class InPieces : public ::testing::Test {
 protected:
  Pieces make(const PiecesLimits& limits = {}) {
    return {folder_.file("pieces"),
            [this](const std::string& path, const std::string& sha256, const std::string& station) {
              EXPECT_FALSE(station.empty());
              const Bytes whole = read_file(path);
              wholes_[sha256] = {whole.begin(), whole.end()};
              std::filesystem::remove(path);
            },
            [this] { return now_s_; }, limits};
  }
  std::size_t files() const {
    const std::filesystem::directory_iterator all(folder_.file("pieces"));
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  }
  static std::string_view part(const std::string& all, std::size_t at, std::size_t size) {
    return std::string_view(all).substr(at, size);
  }

  static constexpr std::size_t k_size = 300'000, k_piece = 100'000;
  test::Folder folder_;
  std::int64_t now_s_ = read_clocks().utc_ns / 1'000'000'000;
  std::map<std::string, std::string> wholes_;
  const std::string exam_ = some_bytes(k_size, 1), hash_ = to_hex(sha256(exam_));
};

TEST_F(InPieces, AreOneExamWhenAllCameAlsoOverARestart) {
  {
    Pieces pieces = make();
    EXPECT_TRUE(pieces.add(k_one, hash_, 0, k_size, part(exam_, 0, k_piece)).taken);
    EXPECT_EQ(pieces.have(k_one, hash_).have, k_piece);
  }
  Pieces pieces = make();
  EXPECT_EQ(pieces.have(k_one, hash_).have, k_piece) << "the server began anew";
  EXPECT_EQ(pieces.have(k_one, hash_).of, k_size);
  EXPECT_TRUE(pieces.add(k_one, hash_, k_piece, k_size, part(exam_, k_piece, k_piece)).taken);
  EXPECT_TRUE(wholes_.empty());
  EXPECT_TRUE(
      pieces.add(k_one, hash_, 2 * k_piece, k_size, part(exam_, 2 * k_piece, k_piece)).whole);
  EXPECT_EQ(wholes_.at(hash_), exam_);
  EXPECT_EQ(files(), 0u);
  EXPECT_EQ(pieces.have(k_one, hash_).of, 0u);
}

TEST_F(InPieces, AreTakenOnceInTheirOrderAndAreNotReplaced) {
  Pieces pieces = make();
  EXPECT_FALSE(pieces.add(k_one, hash_, k_piece, k_size, part(exam_, k_piece, k_piece)).taken)
      << "the first is missing";
  static_cast<void>(pieces.add(k_one, hash_, 0, k_size, part(exam_, 0, k_piece)));
  const std::string other = some_bytes(k_piece, 2);
  const auto again = pieces.add(k_one, hash_, 0, k_size, other);
  EXPECT_FALSE(again.taken) << "what is there stays";
  EXPECT_EQ(again.have, k_piece);
  EXPECT_FALSE(
      pieces.add(k_one, hash_, 2 * k_piece, k_size, part(exam_, 2 * k_piece, k_piece)).taken)
      << "a gap";
  EXPECT_FALSE(pieces.add(k_one, hash_, k_piece, k_size + 1, part(exam_, k_piece, k_piece)).taken)
      << "another size";
  static_cast<void>(pieces.add(k_one, hash_, k_piece, k_size, part(exam_, k_piece, k_piece)));
  EXPECT_TRUE(
      pieces.add(k_one, hash_, 2 * k_piece, k_size, part(exam_, 2 * k_piece, k_piece)).whole);
  EXPECT_EQ(wholes_.at(hash_), exam_);
}

TEST_F(InPieces, OfTwoStationsDoNotMix) {
  Pieces pieces = make();
  const std::string wrong = some_bytes(k_size, 3);  // under the same name
  for (std::size_t at = 0; at < 2 * k_piece; at += k_piece) {
    EXPECT_TRUE(pieces.add(k_one, hash_, at, k_size, part(exam_, at, k_piece)).taken);
    EXPECT_TRUE(pieces.add(k_two, hash_, at, k_size, part(wrong, at, k_piece)).taken);
  }
  EXPECT_THROW(static_cast<void>(pieces.add(k_two, hash_, 2 * k_piece, k_size,
                                            part(wrong, 2 * k_piece, k_piece))),
               Error)
      << "another hash";
  EXPECT_TRUE(wholes_.empty());
  EXPECT_EQ(pieces.have(k_two, hash_).of, 0u) << "it is begun anew";
  EXPECT_TRUE(
      pieces.add(k_one, hash_, 2 * k_piece, k_size, part(exam_, 2 * k_piece, k_piece)).whole);
  EXPECT_EQ(wholes_.at(hash_), exam_);
}

TEST_F(InPieces, AreLimitedInSizeNumberAndLife) {
  Pieces pieces = make({.of_a_station = 2, .all_bytes = 3 * k_size});
  const auto refused = [&](std::uint64_t at, std::uint64_t of, const std::string& bytes) {
    EXPECT_THROW(static_cast<void>(pieces.add(k_one, hash_, at, of, bytes)), Error)
        << at << " of " << of << ": " << bytes.size();
  };
  refused(0, k_size, "");
  refused(0, 0, "x");
  refused(0, k_size, std::string(1000, 'x'));
  refused(0, 8U << 20, std::string(k_largest_piece + 1, 'x'));
  refused(0, k_largest_session + 1, std::string(k_piece, 'x'));
  refused(k_size - 1, k_size, std::string(k_piece, 'x'));
  refused(~0ULL - 10, k_size, std::string(k_piece, 'x'));
  EXPECT_EQ(files(), 0u) << "none of them left anything";
  const auto first_piece = [&](const std::string& station, char name) {
    return pieces.add(station, std::string(64, name), 0, k_size, part(exam_, 0, k_piece)).taken;
  };
  EXPECT_TRUE(first_piece(k_one, 'a'));
  ++now_s_;
  EXPECT_TRUE(first_piece(k_one, 'b'));
  EXPECT_TRUE(first_piece(k_one, 'c')) << "in the place of the oldest";
  EXPECT_EQ(pieces.have(k_one, std::string(64, 'a')).of, 0u);
  EXPECT_EQ(files(), 2u);
  EXPECT_TRUE(first_piece(k_two, 'a'));
  EXPECT_THROW(static_cast<void>(first_piece(k_two, 'b')), DatabaseError)
      << "there is no more room for all";
  now_s_ += k_life_of_pieces_s + 1;
  EXPECT_EQ(pieces.have(k_one, std::string(64, 'b')).of, 0u);
  EXPECT_EQ(files(), 0u);
}

/// Between a station and the office: a line that breaks after so many bytes.
class PoorLine {
 public:
  explicit PoorLine(std::uint16_t office)
      : acceptor_(context_, {boost::asio::ip::make_address("127.0.0.1"), 0}), office_(office) {
    worker_ = std::thread([this] { serve(); });
  }
  ~PoorLine() {
    stop_ = true;
    ::shutdown(acceptor_.native_handle(), SHUT_RDWR);
    worker_.join();
  }
  [[nodiscard]] std::string address() {
    return "https://127.0.0.1:" + std::to_string(acceptor_.local_endpoint().port());
  }
  std::atomic<std::size_t> breaks_after = 0, sent = 0;

 private:
  using Tcp = boost::asio::ip::tcp;
  void serve() {
    while (!stop_) {
      boost::system::error_code wrong;
      Tcp::socket station(context_), office(context_);
      acceptor_.accept(station, wrong);
      if (wrong || stop_) return;
      office.connect({boost::asio::ip::make_address("127.0.0.1"), office_}, wrong);
      std::thread back([&] {
        boost::system::error_code gone;
        for (std::array<char, 4096> part{}; !gone;) {
          const std::size_t n = office.read_some(boost::asio::buffer(part), gone);
          if (gone) break;
          boost::asio::write(station, boost::asio::buffer(part.data(), n), gone);
        }
        ::shutdown(station.native_handle(), SHUT_RDWR);
      });
      std::size_t here = 0;
      for (std::array<char, 4096> part{}; !wrong && here < breaks_after;) {
        const std::size_t n = station.read_some(boost::asio::buffer(part), wrong);
        here += n, sent += n;
        if (!wrong) boost::asio::write(office, boost::asio::buffer(part.data(), n), wrong);
      }
      ::shutdown(station.native_handle(), SHUT_RDWR);
      ::shutdown(office.native_handle(), SHUT_RDWR);
      back.join();
    }
  }
  boost::asio::io_context context_;
  Tcp::acceptor acceptor_;
  std::uint16_t office_;
  std::atomic<bool> stop_ = false;
  std::thread worker_;
};

TEST(PiecesOverTheNetwork, GoOnWhereTheLineBroke) {
  const Opened opened;
  PoorLine line(opened.port());
  constexpr std::size_t k_bytes = 100'000'000, k_breaks_after = 9'000'000;
  const std::string text = some_bytes(k_bytes, 5);
  const Bytes image(text.begin(), text.end());
  line.breaks_after = k_breaks_after;
  int broken = 0;
  json said;
  while (said.is_null() && broken < 50) {
    StationClient station(line.address(), opened.certificate(), to_hex(School::key().public_key),
                          load_station_key(station_key_path()));
    try {
      said = station.hand_in(image);
    } catch (const OfficeUnreachable&) {
      ++broken;
    }
  }
  EXPECT_EQ(said["state"], "waiting") << broken;
  EXPECT_GE(broken, 11) << "100 MB do not go through a line that breaks after 9 MB";
  EXPECT_LT(line.sent, k_bytes + static_cast<std::size_t>(broken + 1) * (k_largest_piece + 100'000))
      << "at most a piece is sent again for each break";
  auto direct = opened.station();
  const json outcome = Opened::outcome(direct, to_hex(sha256(image)));
  EXPECT_EQ(outcome["state"], "refused") << "it arrived whole, and is no exam: " << outcome;
}

TEST(PiecesOverTheNetwork, OfAnExamAreFiled) {
  const Opened opened;
  const std::string path = opened.school().file("e.cavum");
  sit_shortly(k_scenario, path, opened.school().ticket("4711"));
  const Bytes image = read_file(path);
  auto station = opened.station();
  const std::string target = "/station/pieces/" + to_hex(sha256(image));
  const auto put = [&](std::size_t at, std::size_t size) {
    const auto first = image.begin() + static_cast<std::ptrdiff_t>(at);
    return station.ask("PUT", fmt::format("{}?at={}&of={}", target, at, image.size()),
                       {first, first + static_cast<std::ptrdiff_t>(size)});
  };
  std::size_t at = 0;
  Answer last;
  for (; at < image.size(); at += std::min<std::size_t>(k_smallest_piece, image.size() - at)) {
    last = put(at, std::min<std::size_t>(k_smallest_piece, image.size() - at));
    if (at == 0 && last.status == 200) {
      EXPECT_EQ(put(0, k_smallest_piece).status, 409) << "sent twice";
      EXPECT_EQ(station.ask("GET", target, "").body["have"], k_smallest_piece);
    }
  }
  EXPECT_EQ(last.status, 202);
  EXPECT_EQ(Opened::outcome(station, to_hex(sha256(image)))["state"], "filed");
  for (const char* query :
       {"", "?at=0", "?of=9&at=0", "?at=-1&of=9", "?at=0&of=9999999999", "?at=0&of=9&x=1"})
    EXPECT_EQ(station.ask("PUT", target + query, "x").status, 400) << query;
  EXPECT_EQ(opened.visitor().ask("PUT", target + "?at=0&of=1", "x").status, 401)
      << "no station signed it";
}

}  // namespace
}  // namespace cavum::office
