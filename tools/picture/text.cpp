// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/picture/text.hpp"

#include <array>
#include <cstddef>

namespace palpate::picture {
namespace {

using Rows = std::array<std::string_view, kLetterHeight>;

struct Block {
  std::string_view letters;  // side by side in the rows
  Rows rows;                 // '#' is black
};

constexpr Block kFont[] = {
    {"0123456789.,",
     {{
         ".###. ..#.. .###. .###. ...#. ##### .###. ##### .###. .###. ..... ..... ",
         "#...# .##.. #...# #...# ..##. #.... #.... ....# #...# #...# ..... ..... ",
         "#..## ..#.. ....# ....# .#.#. ####. #.... ...#. #...# #...# ..... ..... ",
         "#.#.# ..#.. ...#. ..##. #..#. ....# ####. ..#.. .###. .#### ..... ..... ",
         "##..# ..#.. ..#.. ....# ##### ....# #...# ..#.. #...# ....# ..... ..... ",
         "#...# ..#.. .#... #...# ...#. #...# #...# ..#.. #...# ....# ..#.. ..#.. ",
         ".###. .###. ##### .###. ...#. .###. .###. ..#.. .###. .###. ..#.. ..#.. ",
         "..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... .#... ",
         "..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ..... ",
     }}},
    {"abcdefghijklm",
     {{
         "..... #.... ..... ....# ..... ..##. ..... #.... ..#.. ...#. #.... .##.. ..... ",
         "..... #.... ..... ....# ..... .#... ..... #.... ..... ..... #.... ..#.. ..... ",
         ".###. ####. .###. .#### .###. ####. .#### ####. .##.. ..##. #..#. ..#.. ##.#. ",
         "....# #...# #...# #...# #...# .#... #...# #...# ..#.. ...#. #.#.. ..#.. #.#.# ",
         ".#### #...# #.... #...# ##### .#... #...# #...# ..#.. ...#. ##... ..#.. #.#.# ",
         "#...# #...# #...# #...# #.... .#... #...# #...# ..#.. ...#. #.#.. ..#.. #.#.# ",
         ".#### ####. .###. .#### .###. .#... .#### #...# .###. ...#. #..#. .###. #.#.# ",
         "..... ..... ..... ..... ..... ..... ....# ..... ..... ...#. ..... ..... ..... ",
         "..... ..... ..... ..... ..... ..... .###. ..... ..... .##.. ..... ..... ..... ",
     }}},
    {"nopqrstuvwxyz",
     {{
         "..... ..... ..... ..... ..... ..... .#... ..... ..... ..... ..... ..... ..... ",
         "..... ..... ..... ..... ..... ..... .#... ..... ..... ..... ..... ..... ..... ",
         "####. .###. ####. .#### #.##. .#### ####. #...# #...# #...# #...# #...# ##### ",
         "#...# #...# #...# #...# ##... #.... .#... #...# #...# #.#.# .#.#. #...# ...#. ",
         "#...# #...# #...# #...# #.... .###. .#... #...# #...# #.#.# ..#.. #...# ..#.. ",
         "#...# #...# #...# #...# #.... ....# .#... #...# .#.#. #.#.# .#.#. #...# .#... ",
         "#...# .###. ####. .#### #.... ####. ..##. .#### ..#.. .#.#. #...# .#### ##### ",
         "..... ..... #.... ....# ..... ..... ..... ..... ..... ..... ..... ....# ..... ",
         "..... ..... #.... ....# ..... ..... ..... ..... ..... ..... ..... .###. ..... ",
     }}},
};

bool is_black(char letter, int x, int y) {
  for (const Block& block : kFont) {
    const std::size_t place = block.letters.find(letter);
    if (place == std::string_view::npos) continue;
    const std::size_t column = place * std::size_t{kLetterWidth} + static_cast<std::size_t>(x);
    return block.rows[static_cast<std::size_t>(y)][column] == '#';
  }
  return false;
}

}  // namespace

void draw_text(Raster& raster, int left, int top, int scale, std::string_view line) {
  const int width = scale * kLetterWidth * static_cast<int>(line.size());
  for (int y = 0; y < scale * kLetterHeight; ++y) {
    for (int x = 0; x < width; ++x) {
      const int dot = x / scale;
      const char letter = line[static_cast<std::size_t>(dot / kLetterWidth)];
      if (!is_black(letter, dot % kLetterWidth, y / scale)) continue;
      const int column = left + x, row = top + y;
      if (column < 0 || column >= raster.width || row < 0 || row >= raster.height) continue;
      raster.at(column, row) = kBlack;
    }
  }
}

}  // namespace palpate::picture
