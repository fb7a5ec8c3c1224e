#!/usr/bin/env bash
# Installs raygrain's Debian packages: `build` (library, program, tests; the default) or `full` (Clang, coverage, format too),
# or `bench` (Embree and Python too), `pages` (node and npm too), `browser` (Chromium too).
# Works as root and with sudo; does nothing when everything is there.
set -euo pipefail

packages=(g++ cmake ninja-build make git
          libtbb-dev libhwy-dev libboost-dev libassimp-dev zlib1g-dev libcli11-dev nlohmann-json3-dev libfmt-dev
          libstb-dev libgtest-dev)
if [ "${1:-build}" = full ]; then
  packages+=(clang clang-format clang-tidy libclang-rt-dev gcovr g++-aarch64-linux-gnu qemu-user assimp-testmodels)
fi

if [ "${1:-build}" = bench ]; then
  packages+=(libembree-dev)
  command -v python3 >/dev/null || packages+=(python3)
fi

if [ "${1:-build}" = pages ] && ! command -v npm >/dev/null; then
  packages+=(nodejs npm)
fi

if [ "${1:-build}" = browser ] && ! command -v chromium >/dev/null; then
  packages+=(chromium fonts-dejavu-core)
fi

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query --show --showformat='${Status}' "$package" 2>/dev/null || true)
  [ "$status" = "install ok installed" ] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "raygrain: error: install-dependencies: not root and no sudo. Run as root: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "Installing: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${as_root[@]}" apt-get update -q
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
