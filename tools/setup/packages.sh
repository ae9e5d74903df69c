# SPDX-License-Identifier: Apache-2.0
# Debian 12 packages that the project needs, and how they get there. Sourced by tools/demo, tools/test and tools/hil.

packages_build="g++ cmake ninja-build git ca-certificates libcgal-dev libboost-dev libeigen3-dev libtbb-dev libtomlplusplus-dev libcli11-dev nlohmann-json3-dev libusb-1.0-0-dev libsodium-dev libpng-dev"
# For the page of reports, which is built where node is found.
packages_page="nodejs"
packages_test="$packages_page libgtest-dev clang libclang-rt-14-dev llvm clang-format clang-tidy binutils python3 gcc-arm-none-eabi libnewlib-arm-none-eabi libstdc++-arm-none-eabi-newlib g++-aarch64-linux-gnu qemu-user-static umockdev dfu-util usbip openssl pybind11-dev python3-dev python3-numpy libspnav-dev"
# Only for tests labelled long: reports in a browser, two minutes to install on a bare machine; packages in a bare Debian.
packages_browser="chromium dpkg-dev mmdebstrap"
# Only for tools/bench, which is built where these are found.
packages_bench="libbenchmark-dev libfcl-dev libbullet-dev"

# For tools/hil beside the build's: a kernel in QEMU, and what is packed into its initramfs.
packages_hil="qemu-system-x86 busybox-static rt-tests cpio kmod udev usbip dfu-util xz-utils e2fsprogs util-linux python3"

# need_packages NAME...: installs what is missing; without root by sudo; without either says which are missing and gives up.
need_packages() {
  local missing=() name
  for name in "$@"; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$name" 2>/dev/null)" = installed ] || missing+=("$name")
  done
  [ ${#missing[@]} -gt 0 ] || return 0
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null || ! sudo -v; then
      echo "These Debian packages are missing, and there is no root to install them: ${missing[*]}" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  echo "Installing ${#missing[@]} packages: ${missing[*]}"
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get update -qq -o APT::Sandbox::User=root
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq -o APT::Sandbox::User=root -o Dpkg::Use-Pty=0 --no-install-recommends "${missing[@]}" >/dev/null
}
