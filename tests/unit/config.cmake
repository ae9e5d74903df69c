# SPDX-License-Identifier: Apache-2.0
palpate_test(config_test SOURCES unit/config_scene.cpp unit/config_files.cpp LIBS palpate_config)
target_compile_definitions(config_test PRIVATE PALPATE_CONFIG_FOLDER="${PROJECT_SOURCE_DIR}/config")
