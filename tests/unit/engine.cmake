# SPDX-License-Identifier: Apache-2.0
palpate_test(test_tree SOURCES unit/test_tree.cpp LIBS palpate_rt)
palpate_test(force_penalty SOURCES unit/force_penalty.cpp LIBS palpate_rt)
