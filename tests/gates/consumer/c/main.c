/* SPDX-License-Identifier: Apache-2.0 */
/* program IMAGE: a body presses another one like it. */
#include <stdio.h>
#include <stdlib.h>

#include "rt_core/palpate.h"

static void* read_image(const char* name, size_t* size) {
  FILE* file = fopen(name, "rb");
  if (!file) return 0;
  fseek(file, 0, SEEK_END);
  *size = (size_t)ftell(file);
  rewind(file);
  void* bytes = aligned_alloc(64, (*size + 63) / 64 * 64);
  const size_t read = fread(bytes, 1, *size, file);
  fclose(file);
  return read == *size ? bytes : 0;
}

int main(int count, char** arguments) {
  size_t size = 0;
  const void* bytes = count == 2 ? read_image(arguments[1], &size) : 0;
  palpate_image images[2];
  if (!bytes || palpate_open(bytes, size, &images[0]) != PALPATE_OK) return 1;
  images[1] = images[0];
  const palpate_pair pair = {0, 1};
  const palpate_scene scene = {images, 2, &pair, 1, 0};
  palpate_settings settings;
  palpate_limits limits;
  palpate_default_settings(&settings);
  palpate_default_limits(&limits);
  settings.engine = PALPATE_REGIONS;
  settings.delta_m = 0.05;
  const size_t needed = (palpate_required_bytes(&scene, &limits, settings.engine) + 63) / 64 * 64;
  palpate_engine* engine = 0;
  if (palpate_create(&scene, &settings, &limits, aligned_alloc(64, needed), needed, &engine) !=
      PALPATE_OK) {
    return 1;
  }
  const palpate_pose poses[2] = {{{1.9, 0, 0}, {1, 0, 0, 0}}, {{0, 0, 0}, {1, 0, 0, 0}}};
  const palpate_budget budget = {UINT64_MAX, 0, 0, 0, 0, 0};
  palpate_result result;
  if (palpate_tick(engine, poses, &budget, &result) != PALPATE_OK) return 1;
  printf("%.3f N along x\n", result.force_N[0]);
  return result.force_N[0] > 0 ? 0 : 1;
}
