# SPDX-License-Identifier: GPL-3.0-or-later
# Makes PAGE and LIVE with NODE from SOURCE, with the packages of package-lock.json in PACKAGES. Where the packages cannot be had it
# warns, leaves none, and does not fail: a build without a network is a build all the same. The next one tries again.

# Debian's npm brings 386 packages and takes minutes to install; npm's own is one archive. This one runs on node 18.17 or later.
set(npm_version 10.9.4)
set(npm_sha512 3a7506f37e85c1ba1021baad79f0cd9724748131f321fc117c4dc3ba235ec01be7327584a41d15117c01945560aa9373220628fcc1e1dddd877a5fe9b336a900)

function(run_npm out_failed)
  find_program(npm npm)
  if(npm)
    set(command "${npm}")
  else()
    set(folder "${PACKAGES}/npm-${npm_version}")
    if(NOT EXISTS "${folder}/package/bin/npm-cli.js")
      set(registry "$ENV{npm_config_registry}")
      if(NOT registry)
        set(registry https://registry.npmjs.org)
      endif()
      file(DOWNLOAD "${registry}/npm/-/npm-${npm_version}.tgz" "${folder}.tgz"
        TIMEOUT 120 INACTIVITY_TIMEOUT 20 STATUS status TLS_VERIFY ON)
      file(SHA512 "${folder}.tgz" found)
      if(NOT found STREQUAL npm_sha512)
        set(${out_failed} "npm ${npm_version} could not be fetched: ${status}" PARENT_SCOPE)
        return()
      endif()
      file(ARCHIVE_EXTRACT INPUT "${folder}.tgz" DESTINATION "${folder}")
    endif()
    set(command "${NODE}" "${folder}/package/bin/npm-cli.js")
  endif()
  # node trusts its own list alone; a machine behind a proxy has one more in its own.
  set(system_certificates /etc/ssl/certs/ca-certificates.crt)
  if(NOT DEFINED ENV{NODE_EXTRA_CA_CERTS} AND EXISTS "${system_certificates}")
    set(ENV{NODE_EXTRA_CA_CERTS} "${system_certificates}")
  endif()
  # No package has a say in the build: esbuild's program is in a package of its own.
  execute_process(COMMAND ${command} ci --ignore-scripts --no-audit --no-fund --loglevel=error --fetch-retries=1
      --fetch-retry-mintimeout=2000 --fetch-timeout=30000
    WORKING_DIRECTORY "${PACKAGES}" RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE said)
  if(NOT result EQUAL 0)
    string(REGEX REPLACE "\n.*" "" first "${said}")
    set(${out_failed} "npm ci: ${first}" PARENT_SCOPE)
  endif()
endfunction()

file(REMOVE "${PAGE}" "${LIVE}")
file(MAKE_DIRECTORY "${PACKAGES}")
set(failed "")
file(SHA256 "${SOURCE}/package-lock.json" wanted)
set(have "")
if(EXISTS "${PACKAGES}/have")
  file(READ "${PACKAGES}/have" have)
endif()
if(NOT have STREQUAL wanted)
  file(COPY "${SOURCE}/package.json" "${SOURCE}/package-lock.json" DESTINATION "${PACKAGES}")
  run_npm(failed)
  if(NOT failed)
    file(WRITE "${PACKAGES}/have" "${wanted}")
  endif()
endif()

if(failed)
  message(WARNING "No pages for 'palpate report' and 'palpate run --view': ${failed}\n"
    "All else is built. With a network, build the target report_bundle again.")
else()
  execute_process(COMMAND "${NODE}" "${SOURCE}/build.mjs" "${PACKAGES}" "${PAGE}" "${LIVE}" COMMAND_ERROR_IS_FATAL ANY)
endif()
