// SPDX-License-Identifier: GPL-3.0-or-later
#include "host_bake/decompose/face_tree.hpp"

#include <algorithm>
#include <numeric>

namespace palpate::bake {
namespace {

FaceBox box_of(const NormalMesh& mesh, const std::uint32_t* first, std::size_t count) {
  FaceBox box = FaceBox::empty();
  for (std::size_t i = 0; i < count; ++i)
    for (const std::uint32_t v : mesh.faces[first[i]]) box.add(mesh.points[v]);
  return box;
}

std::size_t longest_axis(const FaceBox& box) {
  std::size_t axis = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (box.high[i] - box.low[i] > box.high[axis] - box.low[axis]) axis = i;
  return axis;
}

}  // namespace

FaceTree::FaceTree(const NormalMesh& mesh)
    : faces_(mesh.faces.size()), leaf_of_face_(mesh.faces.size()), hidden_(mesh.faces.size(), 0) {
  if (faces_.empty()) return;
  std::iota(faces_.begin(), faces_.end(), 0u);
  const auto along = [&](std::uint32_t f, std::size_t axis) {
    const Face& face = mesh.faces[f];
    return mesh.points[face[0]][axis] + mesh.points[face[1]][axis] + mesh.points[face[2]][axis];
  };
  struct Work {
    std::uint32_t node, first, count;
  };
  std::vector<Work> work{{0, 0, static_cast<std::uint32_t>(faces_.size())}};
  nodes_.emplace_back();
  while (!work.empty()) {
    const Work w = work.back();
    work.pop_back();
    const FaceBox box = box_of(mesh, faces_.data() + w.first, w.count);
    nodes_[w.node].box = box;
    nodes_[w.node].faces = w.count;
    if (w.count <= kLeafFaces) {
      nodes_[w.node].first = w.first;
      nodes_[w.node].leaf = true;
      for (std::uint32_t i = w.first; i < w.first + w.count; ++i) leaf_of_face_[faces_[i]] = w.node;
      continue;
    }
    const std::size_t axis = longest_axis(box);
    const auto begin = faces_.begin() + w.first;
    const std::uint32_t half = w.count / 2;
    std::nth_element(begin, begin + half, begin + w.count, [&](std::uint32_t a, std::uint32_t b) {
      const float x = along(a, axis);
      const float y = along(b, axis);
      return x != y ? x < y : a < b;
    });
    const auto children = static_cast<std::uint32_t>(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    nodes_[w.node].first = children;
    nodes_[children].parent = nodes_[children + 1].parent = w.node;
    work.push_back({children, w.first, half});
    work.push_back({children + 1, w.first + half, w.count - half});
  }
}

void FaceTree::count_hidden(std::uint32_t face, std::uint32_t by) {
  hidden_[face] = by == 1 ? 1 : 0;
  for (std::uint32_t node = leaf_of_face_[face];; node = nodes_[node].parent) {
    nodes_[node].hidden += by;
    if (node == 0) return;
  }
}

}  // namespace palpate::bake
