#!/usr/bin/env bash
# packed.sh HAPTEL ROOT: packs the library of materials. Fails, and says why, unless docs/materials.md is the page that this
# makes, shows each texture, and what is packed is installed, built and used in a home of its own.
set -euo pipefail
haptel=$1 root=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
fail() { printf 'packed.sh: %s\n' "$*" >&2; exit 1; }

"$haptel" pack "$root/materials" -o "$folder/materials.haptlib" --gallery "$folder/materials.md"
diff -u "$root/docs/materials.md" "$folder/materials.md" >&2 || fail 'docs/materials.md is old: ./dev docs makes it anew'
while read -r file texture; do
    grep -qF "![$file/$texture](materials/$file/$texture.png)" "$root/docs/materials.md" ||
        fail "docs/materials.md does not show $file:$texture"
    [[ -s $root/docs/materials/$file/$texture.png ]] || fail "there is no picture of $file:$texture: ./dev docs draws it"
done < <(sed -nE 's|^    "([a-z_/0-9]+):([A-Za-z_0-9]+)",$|\1 \2|p' "$root/materials/library.toml")

export HOME=$folder XDG_DATA_HOME=$folder/data
unset HAPTEL_PATH
mkdir "$folder/work"
cd "$folder/work"
"$haptel" install "$folder/materials.haptlib" >/dev/null
cat >mine.haptel <<'TEXT'
import materials.wood.oak;
import materials.stone.granite as stone;

texture mine() { return 0.5 * oak() + 0.5 * stone.granite(depth = 0.1mm); }
TEXT
"$haptel" check --strict mine.haptel >/dev/null
# A quarter of the way over a period of 5 mm: the amplitude.
height=$("$haptel" eval materials.perception.sine_grating:sine_grating --at 1.25mm,0,0 | head -1)
[[ $height == 'height_m 5e-05' ]] || fail "the height of a sine grating of 50 um is $height"
cat >scene.toml <<'TEXT'
[[object]]
shape = "box"
size_m = 0.1
texture = "materials.stone.granite"
parameters = { depth = "0.2mm" }
TEXT
"$haptel" explore scene.toml --seconds 0.2 --clock virtual --json >/dev/null
# All of it, for programs without a compiler.
for emit in header c; do "$haptel" build materials --emit $emit -o materials.${emit:0:1}; done
cc -std=c99 -Wall -Wextra -Wpedantic -Wconversion -Werror -c materials.c -o materials.o || fail 'the C text of the library has warnings'
grep -qF haptel_texture_granite <(nm materials.o) || fail 'the C text of the library has no granite'
echo 'packed, installed, built and used from there'
