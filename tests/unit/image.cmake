# SPDX-License-Identifier: Apache-2.0
palpate_test(image_test SOURCES unit/image_sha256.cpp unit/image_validate.cpp LIBS palpate_rt)
