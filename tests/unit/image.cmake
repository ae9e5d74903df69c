# SPDX-License-Identifier: Apache-2.0
palpate_test(image_test SOURCES unit/image_sha256_test.cpp unit/image_validate_test.cpp LIBS palpate_rt)
