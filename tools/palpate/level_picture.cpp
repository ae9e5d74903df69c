// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/palpate/level_picture.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "tools/palpate/level_mesh.hpp"
#include "tools/picture/text.hpp"
#include "tools/picture/view.hpp"

namespace palpate::cli {
namespace {

// Pixels of the finished picture.
constexpr int kPanelWidth = 280;
constexpr int kMinPanelHeight = 90, kMaxPanelHeight = 280;
constexpr int kMargin = 10;
constexpr int kTextScale = 2;
constexpr int kLine = kTextScale * (picture::kLetterHeight + 1);

constexpr std::size_t kColumns = 3;
constexpr int kSamples = 3;  // a pixel and direction

constexpr picture::Rgb kPlain{200, 200, 196};

using Caption = std::array<std::string, 3>;
constexpr int kCaption = kLine * int{std::tuple_size_v<Caption>};

bool is_original(const ImageView& image, std::uint32_t level) {
  return level == 0 && image.header->dropped_levels == 0;
}

Caption caption_of(const ImageView& image, std::uint32_t index) {
  const image::Level& level = image.levels[index];
  const std::string pieces =
      std::to_string(level.pieces) + (level.pieces == 1 ? " piece" : " pieces");
  if (level.free != 0) return {"free level " + std::to_string(index), pieces, ""};
  std::array<char, 32> resolution{};
  std::snprintf(resolution.data(), resolution.size(), ", r %.1f",
                static_cast<double>(level.resolution));
  return {is_original(image, index) ? "original" : "level " + std::to_string(index),
          std::to_string(level.triangles) + " triangles", pieces + resolution.data()};
}

picture::Raster panel(const LevelMesh& mesh, bool plain, const picture::View& view,
                      const picture::Bounds& bounds, int height) {
  std::vector<picture::Rgb> colours(mesh.faces.size(), kPlain);
  if (!plain) {
    std::transform(mesh.faces.begin(), mesh.faces.end(), colours.begin(), [&mesh](const auto& f) {
      return picture::colour_of(mesh.piece_of_point[f[0]]);
    });
  }
  picture::Raster raster(kSamples * kPanelWidth, kSamples * height);
  picture::draw(raster, view, bounds, {mesh.points, mesh.faces, colours});
  return picture::shrink(raster, kSamples);
}

int panel_height(const picture::Bounds& bounds) {
  const double ratio = (bounds.top - bounds.bottom) / std::max(bounds.right - bounds.left, 1e-3);
  return static_cast<int>(
      std::clamp(ratio * kPanelWidth, double{kMinPanelHeight}, double{kMaxPanelHeight}));
}

}  // namespace

std::vector<std::uint32_t> shown_levels(const ImageView& image) {
  const auto root = static_cast<std::uint32_t>(image.levels.size()) - 1;
  const std::uint32_t free_levels = image.header->free_levels;
  const std::uint32_t coarsest = root - free_levels;
  std::vector<std::uint32_t> levels;
  for (const std::uint32_t level : {0u, (coarsest + 1) / 3, (2 * coarsest + 1) / 3, coarsest,
                                    coarsest + (free_levels + 1) / 2, root}) {
    if (levels.empty() || levels.back() != level) levels.push_back(level);
  }
  return levels;
}

picture::Raster level_picture(const ImageView& image, const std::vector<std::uint32_t>& levels,
                              Vec3d from) {
  const picture::View view = picture::view_from(from);
  std::vector<LevelMesh> meshes;
  picture::Bounds bounds;
  for (const std::uint32_t level : levels) {
    meshes.push_back(level_mesh(image, level));
    const picture::Bounds own = picture::bounds_of(view, meshes.back().points);
    bounds = meshes.size() == 1 ? own : picture::united(bounds, own);
  }
  const int height = panel_height(bounds);
  const int across = kPanelWidth + kMargin, down = height + kCaption + 2 * kMargin;
  const auto columns = static_cast<int>(std::min(kColumns, levels.size()));
  const auto rows = static_cast<int>((levels.size() + kColumns - 1) / kColumns);
  picture::Raster sheet(kMargin + columns * across, kMargin + rows * down);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const int left = kMargin + static_cast<int>(i % kColumns) * across;
    int top = kMargin + static_cast<int>(i / kColumns) * down;
    picture::paste(sheet, panel(meshes[i], is_original(image, levels[i]), view, bounds, height),
                   left, top);
    top += height + kMargin;
    for (const std::string& line : caption_of(image, levels[i])) {
      picture::draw_text(sheet, left, top, kTextScale, line);
      top += kLine;
    }
  }
  return sheet;
}

}  // namespace palpate::cli
