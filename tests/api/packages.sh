#!/usr/bin/env bash
# packages.sh PACKAGES SOURCE [SUITE]: installs the Debian packages of a folder in a bare Debian that has a compiler of
# C++, CMake, pkg-config and Python, and uses them there as somebody would who has nothing else of Haptel: every example
# is built and run. A library of textures is packed there, installed and compiled in a second bare Debian. Its code runs
# in a third, which has nothing of Haptel at all, and so do the examples that need none of Haptel's libraries. The packages
# are for the release on which they were made, SUITE (bookworm, trixie), or else that of this machine. Needs mmdebstrap,
# the network, and no root where the system lets users have namespaces. Nothing stays behind.
set -euo pipefail

say() { printf '==> %s\n' "$*"; }
fail() { printf 'packages.sh: %s\n' "$*" >&2; exit 1; }

if [[ ${1:-} != inside ]]; then
    packages=$(realpath "$1") source=$(realpath "$2")
    suite=${3:-$(. /etc/os-release && echo "$VERSION_CODENAME")}
    made=$(mktemp -d)
    trap 'rm -rf "$made"' EXIT
    chmod 755 "$made"
    mkdir "$made/haptel"
    cp "$packages"/*.deb "$source/tests/api/packages.sh" "$source/tests/api/python_test.py" "$made/haptel"
    cp -r "$source/examples" "$source/tests/api/chai3d_stand_in" "$made/haptel"
    bare() { # STAGE INCLUDED OUT...: files of /haptel that come back
        local stage=$1 included=$2 out=() name
        shift 2
        for name in "$@"; do out+=(--customize-hook="copy-out /haptel/$name $made/haptel"); done
        say "a bare $suite: $stage"
        mmdebstrap --quiet --variant=apt --include="$included" --format=null \
            --customize-hook="copy-in $made/haptel /" --customize-hook="chroot \"\$1\" /haptel/packages.sh inside $stage" \
            "${out[@]}" "$suite" /dev/null
    }
    bare first g++,cmake,make,pkg-config,python3 wood.haptlib alone
    bare second gcc,libc6-dev use_wood libwood.so
    rm "$made"/haptel/*.deb
    bare third libc6
    exit
fi

# From here on in the bare system, as its root.
cd /haptel
export DEBIAN_FRONTEND=noninteractive HOME=/root CFLAGS=-Wall CXXFLAGS=-Wall LC_ALL=C.UTF-8
get() { # NAME...: as `apt install` does, with what they need of the system
    local files=() name
    for name in "$@"; do files+=(/haptel/"$name"_*.deb); done
    say "apt-get install $*"
    apt-get -qq -o Dpkg::Use-Pty=0 install --yes --no-install-recommends "${files[@]}" >log 2>&1 || { cat log; exit 1; }
}
configure() { # EXAMPLE FOLDER OPTION...
    say "cmake -S examples/$1 -B $2"
    cmake -S "examples/$1" -B "$2" "${@:3}" >log 2>&1 && cmake --build "$2" >>log 2>&1 || { cat log; exit 1; }
}
lists() { # NAME: whether a package of that name is installed
    dpkg-query -W -f '${Package} ${db:Status-Abbrev}\n' | grep -E "^$1.* i" # nothing else prints
}

# Another machine: the archive is installed, its textures are used by name, and compiled for programs without Haptel.
second() {
    get haptel
    haptel install wood.haptlib
    haptel list
    printf 'import wood.waves;\ntexture two() { return 2.0 * waves(); }\n' >two.haptel
    haptel eval two.haptel:two --at 0.3mm,2mm,0
    haptel info wood
    local textures
    textures=$(find / -xdev -path '*libraries/wood*/waves.haptel' -not -path '*/tests/*' -print -quit)
    haptel build "$textures" --emit header -o wood.h
    haptel build "$textures" --emit static -o libwood.a
    haptel build "$textures" --emit shared -o libwood.so
    cat >use_wood.c <<'TEXT'
#include "wood.h"
#include <dlfcn.h>
#include <stdio.h>
int main(void)
{
    static haptel_point point;
    haptel_sample linked, loaded;
    void* library = dlopen("/haptel/libwood.so", RTLD_NOW);
    const haptel_texture* texture = library ? dlsym(library, "haptel_texture_waves") : 0;
    if (!texture || texture->abi != HAPTEL_ABI_VERSION) return 1;
    point.p[0] = 0.3e-3;
    point.p[1] = 2e-3;
    haptel_texture_waves.height_gradient(&point, &haptel_defaults_waves, &linked);
    texture->height_gradient(&point, &haptel_defaults_waves, &loaded);
    printf("height_m %.17g, by dlopen %.17g\n", linked.height_m, loaded.height_m);
    return linked.height_m != loaded.height_m || linked.gradient[0] != loaded.gradient[0];
}
TEXT
    gcc -std=c99 -Wall -Werror use_wood.c libwood.a -o use_wood -lm -ldl
    ./use_wood
    haptel remove wood
    ! haptel list | grep -q wood || fail "the library is still there"
}

# A third one, on which nothing of Haptel ever was.
third() {
    ! compgen -G '/usr/lib/*/lib*haptel*' && ! compgen -G '/usr/lib/*/libLLVM*' || fail "the system is not bare"
    ldd use_wood libwood.so alone/*
    ! ldd use_wood libwood.so alone/* | grep -E 'haptel|LLVM|stdc|not found' || fail "the code needs more than libm"
    ./use_wood
    ./alone/precompiled
    ./alone/microcontroller
    say "packed, installed, compiled and used"
}

[[ $2 == first ]] || { "$2"; exit; }

for so in libhaptel[0-9]*_*.deb; do so=${so#libhaptel} so=${so%%_*}; done
lists 'libllvm|libglm|libtomlplusplus' && fail "the system is not bare"

# Without the compiler: headers, library, and the command that compiles textures when the program is built.
get "libhaptel$so" libhaptel-dev
if cmake -S examples/library -B without_command >log 2>&1; then fail "textures would be compiled without the command"; fi
grep -q HAPTEL_COMMAND log || { cat log; fail "it is not said that the command is missing"; }
get haptel
configure library without_compiler
[[ ! -e without_compiler/ball ]] || fail "there is a compiler"
configure chai3d chai3d -DCHAI3D_DIR=/haptel/chai3d_stand_in
mkdir alone
for program in precompiled microcontroller; do
    configure "$program" "$program"
    cp "$program/$program" alone
done
lists 'lib(glm|llvm-?[0-9]*|tomlplusplus|fmt|assimp|usb-[0-9.]*)-dev' && fail "headers of other libraries came along"
apt-get -qq purge --yes haptel libhaptel-dev >log 2>&1 && apt-get -qq autoremove --purge --yes >log 2>&1 || { cat log; exit 1; }
lists libllvm && fail "the runtime needs LLVM"
[[ ! -e /usr/include/haptel && ! -e /usr/bin/haptel ]] || fail "purged packages leave files behind"
say "own_loop, with libhaptel$so alone: $(dpkg-query -W -f '${Depends}' "libhaptel$so")"
./without_compiler/own_loop
ldd without_compiler/own_loop | grep -E 'haptel|LLVM|not found'
! ldd without_compiler/own_loop chai3d/feel | grep -E 'LLVM|not found' || fail "it needs LLVM"
say "feel, over a stand-in for CHAI3D"
felt=$(./chai3d/feel 0.3) # at 500 N/m, 2 mm into the ball where a wave is highest
[[ $felt == "at most 1.00 N" ]] || fail "the example for CHAI3D: $felt"

# With it, by CMake and by pkg-config.
get "libhaptel-compiler$so" libhaptel-dev libhaptel-compiler-dev haptel haptel-materials haptel-udev python3-haptel
for package in $(dpkg-query -W -f '${Package}\n' '*haptel*'); do
    [[ -e /usr/share/doc/$package/copyright ]] || fail "$package has no licence"
done
configure library with_compiler
stone=examples/textures/stone.haptel:stone
for program in "own_loop" "plain $stone" "ball $stone" "ball materials.stone.granite"; do
    say "$program"
    ./with_compiler/$program
done
say "pkg-config haptel-compiler $(pkg-config --modversion haptel-compiler): $(pkg-config --cflags --libs haptel-compiler)"
# shellcheck disable=SC2046
g++ -std=c++20 examples/library/ball.cpp -o by_pkg_config $(pkg-config --cflags --libs haptel-compiler)
./by_pkg_config "$stone" >/dev/null || fail "the program by pkg-config failed"

say "python3 -c 'import haptel'"
python3 python_test.py
say "examples/python/figures.py"
haptel explore examples/scenes/bricks.toml --seconds 2 --clock virtual --out felt >log 2>&1 || { cat log; exit 1; }
python3 examples/python/figures.py --small --out figures --trace felt/trace.csv
(($(wc -l <figures/force_of_trace.csv) == 2001)) || fail "the trace has other ticks"
say "the same with python3-numpy"
apt-get -qq -o Dpkg::Use-Pty=0 install --yes --no-install-recommends python3-numpy >log 2>&1 || { cat log; exit 1; }
python3 -c 'import numpy'
mv figures/force_of_trace.csv .
python3 python_test.py
python3 examples/python/figures.py --small --out figures --trace felt/trace.csv >log || { cat log; exit 1; }
cmp force_of_trace.csv figures/force_of_trace.csv || fail "arrays have other numbers than lists"
say "examples/textures, examples/scenes"
haptel test examples/textures >log 2>&1 || { cat log; exit 1; }
for scene in examples/scenes/*.toml; do
    haptel explore "$scene" --seconds 0.5 --clock virtual >log 2>&1 || { cat log; fail "$scene is not felt"; }
done
say "haptel, and a material by its name"
haptel --version
haptel list | cut -c-100
haptel eval materials.wood.oak --at 1mm,2mm,0
printf 'import materials.wood.oak;\ntexture two() { return 2.0 * oak(); }\n' >two.haptel
haptel eval two.haptel:two --at 1mm,2mm,0
[[ -e /usr/lib/udev/rules.d/60-haptel.rules ]] || fail "udev has no rules"

say "a library, packed"
haptel new --library wood >log 2>&1 || { cat log; exit 1; }
haptel pack wood -o wood.haptlib
haptel pack wood -o again.haptlib
cmp wood.haptlib again.haptlib || fail "packed twice, the archives differ"

say "apt-get purge"
apt-get -qq purge --yes '*haptel*' >log 2>&1 || { cat log; exit 1; }
left=$(find / -xdev -path /haptel -prune -o -path /root -prune -o -path /proc -prune -o -name '*haptel*' -print)
[[ -z $left ]] || fail "left behind: $left"
say "installed, used and taken away"
