// Accounts, sign-ins and their second factor.
#include <sys/stat.h>

#include "engine/base/scratch_folder.h"
#include "tests/ui/office/opened.h"
#include "ui/office/sign_ins.h"

namespace cavum::office {
namespace {

using namespace testing_office;
using testing_basics::bytes_of;

TEST(OneTimeCode, IsWhatRfc6238Prints) {  // appendix B, SHA-1
  const Bytes secret = bytes_of("12345678901234567890");
  const std::pair<std::uint64_t, const char*> vectors[] = {
      {59, "94287082"},         {1111111109, "07081804"}, {1111111111, "14050471"},
      {1234567890, "89005924"}, {2000000000, "69279037"}, {20000000000, "65353130"}};
  for (const auto& [time, code] : vectors)
    EXPECT_EQ(one_time_code(secret, time / 30, 8), code) << time;
}

TEST(OneTimeCode, ItsSecretIsTypedAsRfc4648Prints) {  // section 10, without padding
  const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                         {"f", "MY"},
                                                         {"fo", "MZXQ"},
                                                         {"foo", "MZXW6"},
                                                         {"foob", "MZXW6YQ"},
                                                         {"fooba", "MZXW6YTB"},
                                                         {"foobar", "MZXW6YTBOI"}};
  for (const auto& [text, typed] : vectors) {
    EXPECT_EQ(base32(bytes_of(text)), typed);
    EXPECT_EQ(from_base32(typed), bytes_of(text));
  }
  EXPECT_EQ(from_base32("MZ0"), std::nullopt);
}

TEST(OneTimeCode, IsGoodForAStepBeforeAndAfterAndOnce) {
  const Bytes secret = new_code_secret();
  for (const int step : {-1, 0, 1})
    EXPECT_EQ(counter_of_code(secret, one_time_code(secret, 1000 + step), 30'000), 1000 + step);
  EXPECT_EQ(counter_of_code(secret, one_time_code(secret, 998), 30'000), std::nullopt);
  EXPECT_EQ(counter_of_code(secret, one_time_code(secret, 1002), 30'000), std::nullopt);
  EXPECT_EQ(counter_of_code(secret, "", 30'000), std::nullopt);
}

TEST(SecondFactor, ACodeIsGoodOnceAlsoAfterARestart) {
  const ScratchFolder folder;
  const std::string path = folder.file("used_codes.json");
  {
    UsedCodes codes(path);
    EXPECT_TRUE(codes.use("Anna", 1000));
    EXPECT_FALSE(codes.use("Anna", 1000));
    EXPECT_FALSE(codes.use("Anna", 999)) << "and none before it";
    EXPECT_TRUE(codes.use("Bert \"B\"", 7));
  }
  UsedCodes again(path);
  EXPECT_FALSE(again.use("Anna", 1000));
  EXPECT_FALSE(again.use("Bert \"B\"", 7));
  EXPECT_TRUE(again.use("Anna", 1001));
  write_text_file(path, "[1]");
  EXPECT_THROW(UsedCodes{path}, Error);
}

TEST(Accounts, KeepNoPasswordAndAreReadByTheirOwnerAlone) {
  const testing_basics::Folder folder;
  Accounts accounts(folder.file("office/accounts.json"));
  EXPECT_TRUE(accounts.all().empty());
  accounts.set("Anna", Role::officer, k_password, true);
  accounts.set("Eva", Role::examiner, k_password, false);
  const std::string text = read_text_file(accounts.path());
  EXPECT_EQ(text.find(k_password), std::string::npos);
  EXPECT_NE(text.find("$argon2id$"), std::string::npos);
  EXPECT_NE(accounts.of("Anna")->password_hash, accounts.of("Eva")->password_hash) << "salted";
  struct stat facts {};
  ASSERT_EQ(::stat(accounts.path().c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0777U, 0600U);
  EXPECT_EQ(accounts.sign_in("Anna", k_password)->role, Role::officer);
  EXPECT_FALSE(accounts.sign_in("Anna", "another password"));
  EXPECT_FALSE(accounts.sign_in("Anna", ""));
  EXPECT_FALSE(accounts.sign_in("Nobody", k_password));
  EXPECT_FALSE(accounts.sign_in("Anna", std::string(1U << 20, 'x')));
  accounts.set("Anna", Role::reader, "quite another password", false);
  EXPECT_FALSE(accounts.sign_in("Anna", k_password));
  EXPECT_EQ(accounts.all().size(), 2u);
  accounts.remove("Anna");
  EXPECT_FALSE(accounts.of("Anna"));
  EXPECT_THROW(accounts.remove("Anna"), Error);
}

TEST(Accounts, RefuseShortPasswordsNamesOfTwoLinesAndFilesOfSomethingElse) {
  const testing_basics::Folder folder;
  Accounts accounts(folder.file("accounts.json"));
  EXPECT_THROW(accounts.set("Anna", Role::officer, "short", false), Error);
  EXPECT_THROW(accounts.set("Anna\nEva", Role::officer, k_password, false), Error);
  EXPECT_THROW(accounts.set("", Role::officer, k_password, false), Error);
  EXPECT_FALSE(std::filesystem::exists(accounts.path()));
  write_text_file(
      accounts.path(),
      R"({"format":"cavum accounts 1","accounts":[{"name":"A","role":"king","password":"$argon2id$x"}]})");
  EXPECT_THROW(static_cast<void>(accounts.all()), Error);
}

TEST(SignIns, EndAfterIdlenessAfterAllAndWhenTheyAreEnded) {
  SignIns s;
  const std::string cookie = s.begin({"Anna", Role::officer, "", ""}, 0);
  EXPECT_EQ(cookie.size(), 64u);
  ASSERT_TRUE(s.of(cookie, k_idle_end_s));
  EXPECT_EQ(s.of(cookie, k_idle_end_s + 1)->account.name, "Anna");
  EXPECT_FALSE(s.of(std::string(64, '0'), 0));
  EXPECT_TRUE(s.lasts(cookie, 2 * k_idle_end_s));
  EXPECT_FALSE(s.of(cookie, 2 * k_idle_end_s + 2)) << "idle";
  const std::string busy = s.begin({"Anna", Role::officer, "", ""}, 0);
  for (std::int64_t t = 0; t <= k_absolute_end_s; t += k_idle_end_s) EXPECT_TRUE(s.of(busy, t));
  EXPECT_FALSE(s.of(busy, k_absolute_end_s + 1));
  const std::string third = s.begin({"Anna", Role::officer, "", ""}, 0);
  EXPECT_NE(third, busy);
  s.end(third);
  EXPECT_FALSE(s.of(third, 0));
}

TEST(SignIns, TooManyTriesWaitAMinute) {
  Tries t;
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(t.allow("a", 5, 0));
  EXPECT_FALSE(t.allow("a", 5, Tries::k_tries_s));
  EXPECT_TRUE(t.allow("b", 5, 0)) << "of another key";
  EXPECT_TRUE(t.allow("a", 5, Tries::k_tries_s + 1));
  for (int i = 0; i < 5; ++i) static_cast<void>(t.allow("c", 5, 0));
  t.forget("c");
  EXPECT_TRUE(t.allow("c", 5, 0));
}

TEST(SignIn, GuessingIsSlowedDownAndTheCookieIsHttpsOnly) {
  const Opened opened;
  Visitor v = opened.visitor();
  const std::string set =
      v.sign_in(Opened::name_of(Role::reader), k_password).fields.at("set-cookie");
  for (const char* part : {"__Host-cavum=", "Path=/", "Secure", "HttpOnly", "SameSite=Strict"})
    EXPECT_NE(set.find(part), std::string::npos) << set;
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(opened.visitor().sign_in(Opened::name_of(Role::officer), "wrong password").status,
              401);
  EXPECT_EQ(opened.visitor().sign_in(Opened::name_of(Role::officer), k_password).status, 429);
  EXPECT_EQ(opened.visitor().sign_in(Opened::name_of(Role::examiner), k_password).status, 200)
      << "another's account";
}

TEST(SignIn, IsOverWhenItIsEndedOrTheAccountIsGoneOrChanged) {
  const Opened opened;
  const Visitor a = opened.signed_in(Role::reader), b = opened.signed_in(Role::reader),
                c = opened.signed_in(Role::invigilator);
  EXPECT_EQ(a.post("/api/sign-out", {}).status, 200);
  EXPECT_EQ(a.get("/api/me").status, 401);
  EXPECT_EQ(b.get("/api/me").status, 200);
  opened.accounts().set(Opened::name_of(Role::reader), Role::officer, k_password, false);
  EXPECT_EQ(b.get("/api/me").status, 401) << "no role comes into a sign-in from before";
  opened.accounts().remove(Opened::name_of(Role::invigilator));
  EXPECT_EQ(c.get("/api/board").status, 401);
}

}  // namespace
}  // namespace cavum::office
