#include "engine/base/bytes.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/engine/support/engine_testing.h"

namespace cavum {
namespace {

using namespace testing_engine;

TEST(Bytes, ReadsBackWhatWasWritten) {
  Random random(drawn_seed("Bytes.ReadsBackWhatWasWritten"));
  for (int round = 0; round < 200; ++round) {
    const auto shift = random.below(64);
    const std::uint64_t u = random.next() >> shift;
    const auto s = static_cast<std::int64_t>(random.next()) >> shift;
    const double d = random.normal();
    const std::string text(random.below(40), static_cast<char>(random.below(256)));
    ByteWriter out;
    out.put_varint(u);
    out.put(d);
    out.put_signed_varint(s);
    out.put_string(text);
    out.put(static_cast<std::uint16_t>(u));
    ByteReader in(out.bytes(), "x");
    EXPECT_EQ(in.get_varint(), u);
    EXPECT_EQ(in.get<double>(), d);
    EXPECT_EQ(in.get_signed_varint(), s);
    EXPECT_EQ(in.get_string(), text);
    EXPECT_EQ(in.get<std::uint16_t>(), static_cast<std::uint16_t>(u));
    EXPECT_EQ(in.left(), 0u);
  }
}

TEST(Bytes, KeepTheExtremesOfVarints) {
  ByteWriter out;
  const auto least = std::numeric_limits<std::int64_t>::min(),
             most = std::numeric_limits<std::int64_t>::max();
  out.put_signed_varint(least);
  out.put_signed_varint(most);
  out.put_varint(~0ULL);
  ByteReader in(out.bytes(), "x");
  EXPECT_EQ(in.get_signed_varint(), least);
  EXPECT_EQ(in.get_signed_varint(), most);
  EXPECT_EQ(in.get_varint(), ~0ULL);
}

TEST(Bytes, AreLittleEndianAndLeb128OnDisk) {
  ByteWriter out;
  out.put(std::uint32_t{0x01020304});
  out.put_varint(300);
  out.put_string("ab");
  EXPECT_EQ(out.bytes(), (Bytes{4, 3, 2, 1, 0xac, 0x02, 2, 0, 0, 0, 'a', 'b'}));
}

TEST(Bytes, EveryTruncationIsAnErrorThatNamesTheFile) {
  ByteWriter out;
  out.put(1.5);
  out.put_varint(1ULL << 40);
  out.put_string("tissue");
  for (std::size_t kept = 0; kept < out.bytes().size(); ++kept) {
    ByteReader in(std::span(out.bytes()).first(kept), "here.cvt");
    const auto all = [&] {
      (void)in.get<double>();
      (void)in.get_varint();
      (void)in.get_string();
    };
    EXPECT_EQ(place_of(thrown_by(all)), "here.cvt") << kept;
  }
}

TEST(Bytes, ALengthBeyondTheEndIsAnErrorAndNoAllocation) {
  ByteWriter out;
  out.put(std::uint32_t{0xffffffff});
  out.put(std::uint8_t{1});
  ByteReader in(out.bytes(), "x");
  EXPECT_THROW((void)in.get_string(), Error);
  ByteReader again(out.bytes(), "x");
  (void)again.get<std::uint8_t>();
  EXPECT_THROW((void)again.get_bytes(std::numeric_limits<std::size_t>::max()),
               Error);  // must not wrap around
  EXPECT_EQ(again.left(), 4u);
}

TEST(Bytes, AnEndlessVarintIsAnError) {
  const Bytes endless(20, 0xff);
  ByteReader in(endless, "x");
  EXPECT_THROW((void)in.get_varint(), Error);
}

}  // namespace
}  // namespace cavum
