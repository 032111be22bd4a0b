#!/usr/bin/env bash
# installed.sh BUILD SOURCE FOLDER COMPILER: installs BUILD into FOLDER, and uses it from there as a program of somebody
# else does: each public header alone, with all warnings and no header of a library; the examples by find_package and by
# pkg-config; in C and in Python; without a compiler of textures no LLVM is loaded.
set -euo pipefail

build=$1 source=$2 folder=$3 compiler=$4
fail() { printf 'installed.sh: %s\n' "$*" >&2; exit 1; }

rm -rf "$folder"
root=$folder/root
install_parts() {
    for part in "$@"; do
        cmake --install "$build" --prefix "$root" --component "$part" >"$folder.log" || { cat "$folder.log"; exit 1; }
    done
}
configure() {
    cmake -S "$source/examples/library" -B "$folder/$1" -DCMAKE_PREFIX_PATH="$root" -DCMAKE_CXX_COMPILER="$compiler" \
        >"$folder.log" && cmake --build "$folder/$1" >>"$folder.log" || { cat "$folder.log"; exit 1; }
}
install_parts runtime tools development
configure without_compiler
"$folder/without_compiler/own_loop" || fail "the example with its own loop failed"
ldd "$folder/without_compiler/own_loop" | grep -i llvm && fail "LLVM is loaded without a compiler"
mkdir "$folder/needs_compiler"
printf 'cmake_minimum_required(VERSION 3.25)\nproject(needs LANGUAGES CXX)\nfind_package(Haptel REQUIRED COMPONENTS compiler)\n' \
    >"$folder/needs_compiler/CMakeLists.txt"
! cmake -S "$folder/needs_compiler" -B "$folder/needs_compiler/build" -DCMAKE_PREFIX_PATH="$root" >"$folder.log" 2>&1 ||
    fail "a compiler is found that is not installed"
grep -q "compiler of textures is not" "$folder.log" || { cat "$folder.log"; fail "it is not said what is missing"; }
install_parts compiler compiler_development python

for header in "$root"/include/haptel/*.h; do
    name=haptel/${header##*/}
    printf '#include <%s>\n#include <%s>\nint main() {}\n' "$name" "$name" >"$folder/alone.cpp"
    "$compiler" -std=c++20 -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror -fsyntax-only -I"$root/include" \
        "$folder/alone.cpp" || fail "$name cannot be included by itself"
    "$compiler" -std=c++20 -I"$root/include" -M "$folder/alone.cpp" | tr ' \\' '\n\n' |
        grep -E 'glm|llvm|toml|fmt|libusb|assimp|catch' && fail "$name includes a header of a library"
done
printf '#include <haptel/abi.h>\nint main(void) { return 0; }\n' >"$folder/abi.c"
cc -std=c99 -Wall -Wextra -Wpedantic -Werror -fsyntax-only -I"$root/include" "$folder/abi.c"
cc -std=c99 -Wall -Wextra -Wpedantic -Werror -fsyntax-only -I"$root/include" "$source/examples/library/plain.c"

configure examples
"$folder/examples/plain" "$source/examples/textures/stone.haptel:stone" || fail "the example in C failed"
"$folder/examples/ball" "$source/examples/textures/stone.haptel:stone" || fail "the example of a ball failed"

build_chai3d() { # OPTION...
    cmake -S "$source/examples/chai3d" -B "$folder/chai3d" -DCMAKE_PREFIX_PATH="$root" -DCMAKE_CXX_COMPILER="$compiler" \
        -DCMAKE_CXX_FLAGS="-Wall -Wextra -Werror" "$@" >"$folder.log" && cmake --build "$folder/chai3d" >>"$folder.log" ||
        { cat "$folder.log"; exit 1; }
}
build_chai3d -DCMAKE_DISABLE_FIND_PACKAGE_CHAI3D=ON
[[ ! -e $folder/chai3d/feel ]] || fail "the example for CHAI3D is built without it"
build_chai3d -DCMAKE_DISABLE_FIND_PACKAGE_CHAI3D=OFF -DCHAI3D_DIR="$source/tests/api/chai3d_stand_in"
felt=$("$folder/chai3d/feel" 0.3) # at 500 N/m, 2 mm into the ball where a wave is highest
[[ $felt == "at most 1.00 N" ]] || fail "the example for CHAI3D: $felt"

export PKG_CONFIG_PATH
PKG_CONFIG_PATH=$(find "$root" -type d -name pkgconfig)
libraries=$(dirname "$PKG_CONFIG_PATH")
# shellcheck disable=SC2046
"$compiler" -std=c++20 "$source/examples/library/ball.cpp" -o "$folder/by_pkg_config" \
    $(pkg-config --cflags --libs haptel-compiler)
LD_LIBRARY_PATH=$libraries "$folder/by_pkg_config" "$source/examples/textures/stone.haptel:stone" >/dev/null || fail "the program by pkg-config failed"

HAPTEL_LIBRARIES=$libraries PYTHONPATH=$(dirname "$(find "$root" -name haptel.py)") PYTHONDONTWRITEBYTECODE=1 \
    python3 "$source/tests/api/python_test.py" || fail "the Python module failed"

# What the libraries show is what the headers declare.
for library in haptel haptel_compiler; do
    nm -DC --defined-only "$libraries/lib$library.so" |
        grep -E ' (T|D|B) ' | grep -vE ' (haptel::[A-Za-z_]+(::|\()|haptel_[a-z_]+$|(vtable|typeinfo)|_edata|_end|__bss_start)' && fail "lib$library shows more"
    nm -DC --defined-only "$libraries/lib$library.so" | grep -E ' T .*haptel::(runtime|jit|lang|ir|device|input)::' &&
        fail "lib$library shows what is inside"
done
echo "installed, and used from there"
