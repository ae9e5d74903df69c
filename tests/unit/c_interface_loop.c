/* SPDX-License-Identifier: Apache-2.0 */
/* The loop of docs/EMBEDDING.md, as C: compiled by a C compiler, called by c_interface.cpp. */
/* loop */
#include <stdlib.h>

#include "rt_core/palpate.h"

/* Where the device is, and what it is told. */
int read_device(palpate_pose* tool);
void push_device(const double force_N[3], const double torque_Nm[3]);
uint64_t cycle_ns(void* context);

int run(const void* tool_image, size_t tool_bytes, const void* part_image, size_t part_bytes) {
  palpate_image images[2];
  if (palpate_open(tool_image, tool_bytes, &images[0]) != PALPATE_OK) return 1;
  if (palpate_open(part_image, part_bytes, &images[1]) != PALPATE_OK) return 1;
  const palpate_pair pairs[] = {{0, 1}};
  const palpate_scene scene = {images, 2, pairs, 1, 0};
  palpate_settings settings;
  palpate_limits limits;
  palpate_default_settings(&settings);
  palpate_default_limits(&limits);
  settings.engine = PALPATE_REGIONS;
  settings.delta_m = 0.0005;
  /* Once, on a 64-byte boundary; firmware prints the number and sets an array of it aside. */
  const size_t bytes = (palpate_required_bytes(&scene, &limits, settings.engine) + 63) / 64 * 64;
  void* memory = aligned_alloc(64, bytes);
  palpate_engine* engine = 0;
  if (palpate_create(&scene, &settings, &limits, memory, bytes, &engine) != PALPATE_OK) {
    free(memory);
    return 1;
  }
  palpate_pose poses[2] = {{{0, 0, 0}, {1, 0, 0, 0}}, {{0, 0, 0}, {1, 0, 0, 0}}};
  while (read_device(&poses[0])) {
    const palpate_budget budget = {UINT64_MAX, cycle_ns, 0, cycle_ns(0) + 400000, 0, 0};
    const double still[3] = {0, 0, 0};
    palpate_result result;
    if (palpate_tick(engine, poses, &budget, &result) == PALPATE_OK) {
      push_device(result.force_N, result.torque_Nm);
    } else {
      push_device(still, still);
    }
  }
  free(memory);
  return 0;
}
/* end */
