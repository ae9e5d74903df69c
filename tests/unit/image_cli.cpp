// SPDX-License-Identifier: GPL-3.0-or-later
// `palpate inspect` and `palpate emit` as processes.
#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "../support/process.hpp"
#include "../support/temporary_folder.hpp"
#include "../support/tiny_image.hpp"

namespace palpate::test {
namespace {

std::string_view as_text(std::span<const std::byte> bytes) {
  return {static_cast<const char*>(static_cast<const void*>(bytes.data())), bytes.size()};
}

/// Two boxes side by side, in metres: half a metre long each.
class ImageCommands : public testing::Test {
 protected:
  ImageCommands() {
    ImageParts parts = parts_of({box_part({-0.25f, 0, 0}, {0.25f, 0.125f, 0.125f}),
                                 box_part({0.25f, 0, 0}, {0.25f, 0.125f, 0.125f})},
                                2.0);
    parts.header.centre_m[2] = 10;
    bytes_ = seal(parts);
    folder_.write("boxes.palp", as_text(bytes_));
  }

  [[nodiscard]] std::string path(const std::string& name) const {
    return (folder_.path() / name).string();
  }
  [[nodiscard]] Outcome palpate(std::vector<std::string> arguments) const {
    arguments.emplace(arguments.begin(), PALPATE_EXECUTABLE);
    return run(arguments);
  }
  [[nodiscard]] Outcome inspect(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"inspect", path("boxes.palp")});
    return palpate(arguments);
  }
  [[nodiscard]] Outcome emit(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"emit", path("boxes.palp"), "-o", path("out")});
    return palpate(arguments);
  }
  void expect_refusal(const Outcome& outcome, int status, const std::string& words) const {
    EXPECT_EQ(outcome.status, status) << outcome.err;
    EXPECT_EQ(outcome.err.rfind("palpate: error: ", 0), 0u) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find('\n'), outcome.err.size() - 1) << outcome.err;
    EXPECT_FALSE(std::filesystem::exists(path("out")));
  }

  AlignedBytes bytes_;
  TemporaryFolder folder_;
};

TEST_F(ImageCommands, Inspect_prints_header_table_and_levels) {
  const Outcome outcome = inspect({});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  for (const char* words : {"format 3.0", "24 triangles", "radius 2 m", "Orig. Tris", "free"}) {
    EXPECT_NE(outcome.out.find(words), std::string::npos) << words << "\n" << outcome.out;
  }
}

TEST_F(ImageCommands, InspectJson_has_the_promised_keys) {
  const Outcome outcome = inspect({"--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json.at("format_version"), "3.0");
  EXPECT_EQ(json.at("bytes"), bytes_.size());
  EXPECT_EQ(json.at("radius_m"), 2.0);
  EXPECT_EQ(json.at("pieces_total"), 3);
  EXPECT_GT(json.at("engine_bytes"), 0);
  EXPECT_EQ(json.at("source").at("triangles"), 24);
  EXPECT_EQ(json.at("levels").size(), 2u);
  EXPECT_EQ(json.at("levels")[0].at("pieces"), 2);
  EXPECT_TRUE(json.at("levels")[1].at("triangles").is_null());
  EXPECT_TRUE(json.at("regions").is_null());
}

TEST_F(ImageCommands, InspectVerify_prints_a_line_an_invariant) {
  const Outcome outcome = inspect({"--verify"});
  EXPECT_EQ(outcome.status, 0) << outcome.err << outcome.out;
  EXPECT_EQ(outcome.out.find("FAILS"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("holds  every source triangle"), std::string::npos) << outcome.out;
}

TEST_F(ImageCommands, InspectVerify_of_a_false_image_is_refused) {
  // Sound to validate(): one triangle of the source twice, another one never.
  ImageParts parts = parts_of({box_part({0, 0, 0}, {0.5f, 0.5f, 0.5f})});
  parts.triangles[3].source = 4;
  folder_.write("boxes.palp", as_text(seal(parts)));
  const Outcome outcome = inspect({"--verify"});
  expect_refusal(outcome, 3, "1 of ");
  EXPECT_NE(outcome.out.find("FAILS  every source triangle"), std::string::npos) << outcome.out;
  const Outcome as_json = inspect({"--verify", "--json"});
  EXPECT_EQ(as_json.status, 3);
  EXPECT_EQ(nlohmann::json::parse(as_json.out).at("verify")[0].at("holds"), false);
}

TEST_F(ImageCommands, ExportLod_writes_the_level_in_metres) {
  for (const auto& [level, vertices, faces] :
       {std::tuple{"0", 16u, 24u}, std::tuple{"1", 8u, 12u}}) {
    const Outcome outcome = inspect({"--export-lod", level, "-o", path("level.ply")});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const std::string ply = read_file(path("level.ply"));
    EXPECT_NE(ply.find("element vertex " + std::to_string(vertices) + "\n"), std::string::npos);
    EXPECT_NE(ply.find("element face " + std::to_string(faces) + "\n"), std::string::npos);
    const std::size_t start = ply.find("end_header\n") + 11;
    ASSERT_EQ(ply.size(), start + vertices * 27 + faces * 13);
    for (std::size_t v = 0; v < vertices; ++v) {
      double z = 0;
      std::memcpy(&z, ply.data() + start + v * 27 + 16, sizeof(z));
      EXPECT_EQ(std::abs(z - 10), 0.25);
    }
  }
}

TEST_F(ImageCommands, ExportLod_of_no_such_level_is_refused) {
  expect_refusal(inspect({"--export-lod", "2", "-o", path("out")}), 2, "levels 0 to 1");
  EXPECT_EQ(inspect({"--export-lod", "1"}).status, 2);
}

TEST_F(ImageCommands, BadImages_are_refused_with_the_reason) {
  const std::string text(as_text(bytes_));
  folder_.write("boxes.palp", text.substr(0, text.size() - 1));
  expect_refusal(inspect({}), 3, "cut or padded");
  std::string damaged = text;
  damaged[1000] = static_cast<char>(damaged[1000] ^ 1);
  folder_.write("boxes.palp", damaged);
  expect_refusal(emit({"--as", "hex"}), 3, "damaged");
  folder_.write("boxes.palp", "");
  expect_refusal(inspect({}), 3, "smaller than");
  folder_.write("boxes.palp", std::string(1000, 'x'));
  expect_refusal(inspect({}), 3, "magic");
  expect_refusal(palpate({"inspect", path("none.palp")}), 3, "no such image");
  expect_refusal(palpate({"inspect", folder_.path().string()}), 3, "not a regular file");
}

TEST_F(ImageCommands, Emit_writes_each_form) {
  ASSERT_EQ(emit({"--as", "c", "--symbol", "scan"}).status, 0);
  EXPECT_NE(read_file(path("out")).find("const unsigned char scan["), std::string::npos);
  ASSERT_EQ(emit({"--as", "hex", "--address", "0x08040000"}).status, 0);
  EXPECT_EQ(read_file(path("out")).rfind(":020000040804EE\n", 0), 0u);
  for (const std::string machine : {"x86_64", "aarch64", "arm"}) {
    ASSERT_EQ(emit({"--as", "elf", "--machine", machine}).status, 0);
    EXPECT_EQ(read_file(path("out"))
                  .rfind("\x7f"
                         "ELF",
                         0),
              0u);
    EXPECT_NE(read_file(path("out")).find("palpate_image_start"), std::string::npos);
  }
}

TEST_F(ImageCommands, EmitDfu_appends_the_suffix_with_the_identifiers) {
  ASSERT_EQ(emit({"--as", "dfu", "--vendor-id", "0x1209", "--product-id", "0xabcd"}).status, 0);
  const std::string file = read_file(path("out")), image = read_file(path("boxes.palp"));
  ASSERT_EQ(file.size(), image.size() + 16);
  EXPECT_EQ(file.substr(0, image.size()), image);
  EXPECT_EQ(file.substr(image.size(), 12),
            "\xff\xff\xcd\xab\x09\x12" + std::string("\0\x01UFD\x10", 6));
}

TEST_F(ImageCommands, Emit_of_what_cannot_be_made_is_refused) {
  expect_refusal(emit({"--as", "dfu", "--address", "64"}), 2, "no meaning");
  expect_refusal(emit({"--as", "hex", "--vendor-id", "0x1209"}), 2, "no meaning");
  expect_refusal(emit({"--as", "dfu", "--vendor-id", "0x12345"}), 2, "--vendor-id");
  expect_refusal(emit({"--as", "exe"}), 2, "--as");
  expect_refusal(emit({"--as", "c", "--symbol", "3d"}), 2, "C identifier");
  expect_refusal(emit({"--as", "c", "--symbol", "a;b"}), 2, "C identifier");
  expect_refusal(emit({"--as", "elf", "--section", "a\"b"}), 2, "section name");
  expect_refusal(emit({"--as", "hex", "--address", "4"}), 2, "multiple of 64");
  expect_refusal(emit({"--as", "hex", "--address", "0xffffffc0"}), 2, "4 GiB");
  expect_refusal(emit({"--as", "hex", "--symbol", "scan"}), 2, "no meaning");
  expect_refusal(emit({"--as", "c", "--machine", "arm"}), 2, "no meaning");
}

}  // namespace
}  // namespace palpate::test
