// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "rt_core/palpate_rt.hpp"

int main() {
  palpate::ImageView view;
  const palpate::Status status = palpate::validate({}, view);
  std::printf("an empty image is %s\n", palpate::describe(status));
  return status == palpate::Status::image_too_small ? 0 : 1;
}
