#!/usr/bin/env bash
# arm64.sh SOURCE_DIR BUILD_DIR: cross-compiles the replayer for arm64 into BUILD_DIR, and prints the command that runs it here, under qemu-user.
# Debian's arm64 libraries are unpacked into BUILD_DIR/root, once: nothing of this machine is changed. Needs debootstrap, g++-aarch64-linux-gnu and qemu-user-static.
set -euo pipefail
source=$1 build=$2
root=$build/root
libraries=libc6-dev,libstdc++-12-dev,libsodium-dev,libzstd-dev,libxxhash-dev,libtomlplusplus-dev,libsqlite3-dev,libmuparser-dev,libopenmesh-dev,nlohmann-json3-dev,libfmt-dev
{
  if [ "$(cat "$root.whole" 2>/dev/null)" != "$libraries" ]; then
    rm -rf "$root"
    debootstrap --foreign --arch=arm64 --variant=minbase --include="$libraries" bookworm "$root"
    for package in "$root"/var/cache/apt/archives/*.deb; do dpkg -x "$package" "$root"; done
    rm -rf "$root"/var/cache/apt/archives
    find "$root/usr/lib" -lname '/*' | while read -r link; do ln -sfn "$root$(readlink "$link")" "$link"; done  # they would lead to this machine's own
    echo "$libraries" >"$root.whole"
  fi
  cat >"$build/toolchain.cmake" <<EOF
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_SYSROOT $root)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
EOF
  export PKG_CONFIG_SYSROOT_DIR=$root PKG_CONFIG_LIBDIR=$root/usr/lib/aarch64-linux-gnu/pkgconfig:$root/usr/share/pkgconfig
  cmake -G Ninja -S "$source" -B "$build" -DCMAKE_TOOLCHAIN_FILE="$build/toolchain.cmake" -DCMAKE_BUILD_TYPE=Release -DCAVUM_REPLAYER=ON -DCAVUM_IMPORT=OFF
  cmake --build "$build" --target replayer
} >&2
printf '#!/bin/sh\nexec qemu-aarch64-static -L %q %q "$@"\n' "$root" "$build/replayer" >"$build/run"
chmod +x "$build/run"
echo "$build/run"
