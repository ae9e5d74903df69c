// SPDX-License-Identifier: GPL-3.0-or-later
// `palpate key` as a process, and OpenSSL as the witness of its files and signatures.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "../support/process.hpp"
#include "../support/temporary_folder.hpp"
#include "../support/tiny_image.hpp"

namespace palpate {
namespace {

class Key : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.path() / name; }
  [[nodiscard]] static test::Outcome palpate(std::vector<std::string> arguments) {
    arguments.emplace(arguments.begin(), PALPATE_EXECUTABLE);
    return test::run(std::move(arguments));
  }
  test::TemporaryFolder folder_;
};

TEST_F(Key, secret_is_for_its_owner_alone_and_never_overwritten) {
  const test::Outcome made = palpate({"key", path("secret.pem"), "--new"});
  ASSERT_EQ(made.status, 0) << made.err;
  EXPECT_EQ(made.out.rfind("-----BEGIN PUBLIC KEY-----\n", 0), 0u);
  using std::filesystem::perms;
  EXPECT_EQ(std::filesystem::status(path("secret.pem")).permissions() &
                (perms::group_all | perms::others_all),
            perms::none);
  const std::string before = test::read_file(path("secret.pem"));
  EXPECT_EQ(palpate({"key", path("secret.pem"), "--new"}).status, 2);
  EXPECT_EQ(test::read_file(path("secret.pem")), before);
  EXPECT_EQ(palpate({"key", path("secret.pem")}).out, made.out);
  ASSERT_EQ(palpate({"key", path("other.pem"), "--new"}).status, 0);
  EXPECT_NE(palpate({"key", path("other.pem")}).out, made.out);
}

TEST_F(Key, what_is_no_key_is_refused) {
  folder_.write("text", "no key");
  folder_.write("cut", "-----BEGIN PRIVATE KEY-----\nMC4CAQAw\n-----END PRIVATE KEY-----\n");
  for (const char* name : {"text", "cut", "none"}) {
    const test::Outcome outcome = palpate({"key", path(name)});
    EXPECT_EQ(outcome.status, 3) << name;
    EXPECT_EQ(outcome.err.rfind("palpate: error: not a secret key, ", 0), 0u) << outcome.err;
  }
}

TEST_F(Key, signing_wants_a_form_that_can_hold_it) {
  const auto bytes = test::seal(test::parts_of({test::tetrahedron_part()}));
  folder_.write("one.palp", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  ASSERT_EQ(palpate({"key", path("secret.pem"), "--new"}).status, 0);
  EXPECT_EQ(palpate({"emit", path("one.palp"), "--as", "hex", "--sign", path("secret.pem"), "-o",
                     path("out")})
                .status,
            2);
  EXPECT_EQ(palpate({"emit", path("one.palp"), "--as", "dfu", "--counter", "3", "-o", path("out")})
                .status,
            2);
}

#ifdef OPENSSL
TEST_F(Key, openssl_makes_keys_that_are_taken_and_verifies_what_is_signed) {
  ASSERT_EQ(
      test::run({OPENSSL, "genpkey", "-algorithm", "ed25519", "-out", path("secret.pem")}).status,
      0);
  ASSERT_EQ(palpate({"key", path("secret.pem"), "--public", path("public.pem")}).status, 0);
  const auto bytes = test::seal(test::parts_of({test::tetrahedron_part()}));
  folder_.write("one.palp", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  ASSERT_EQ(palpate({"emit", path("one.palp"), "--as", "dfu", "--sign", path("secret.pem"),
                     "--counter", "7", "-o", path("one.dfu")})
                .status,
            0);
  // Image, statement of 64 bytes, signature of 64 bytes, suffix of 16 bytes.
  const std::string file = test::read_file(path("one.dfu"));
  ASSERT_EQ(file.size(), bytes.size() + 64 + 64 + 16);
  folder_.write("statement", file.substr(bytes.size(), 64));
  folder_.write("signature", file.substr(bytes.size() + 64, 64));
  const test::Outcome verified =
      test::run({OPENSSL, "pkeyutl", "-verify", "-pubin", "-inkey", path("public.pem"), "-rawin",
                 "-in", path("statement"), "-sigfile", path("signature")});
  EXPECT_EQ(verified.status, 0) << verified.out << verified.err;
}
#endif

}  // namespace
}  // namespace palpate
