#!/usr/bin/env bash
# packages_made.sh BUILD FOLDER: makes the Debian packages of BUILD in FOLDER, and reads what they say of themselves:
# names, versions, what they need of each other and of the system, and that each file is in the package where it belongs.
set -euo pipefail

build=$1 folder=$2
fail() { printf 'packages_made.sh: %s\n' "$*" >&2; exit 1; }

rm -rf "$folder"
# What the command needs of the system is not looked up: it takes as long as all the rest.
cpack --config "$build/CPackConfig.cmake" -B "$folder" -D CPACK_DEBIAN_COMPRESSION_TYPE=gzip \
    -D CPACK_DEBIAN_TOOLS_PACKAGE_SHLIBDEPS=OFF >"$folder.log" 2>&1 || { cat "$folder.log"; exit 1; }
rm -rf "$folder/_CPack_Packages"

declare -A of
for file in "$folder"/*.deb; do of[$(dpkg-deb -f "$file" Package)]=$file; done
so=$(sed -n 's/^set(CPACK_PACKAGE_VERSION "\([0-9]*\.[0-9]*\).*/\1/p' "$build/CPackConfig.cmake")
expected="haptel haptel-materials haptel-udev libhaptel$so libhaptel-compiler$so libhaptel-compiler-dev libhaptel-dev python3-haptel"
[[ $(printf '%s\n' "${!of[@]}" | sort) == $(printf '%s\n' $expected | sort) ]] || fail "other packages: ${!of[*]}"

field() { dpkg-deb -f "${of[$1]}" "$2"; }
needs() { # NAME PATTERN
    field "$1" Depends | tr ',' '\n' | grep -qE "^ *$2" || fail "$1 does not depend on $2, but on: $(field "$1" Depends)"
}
needs_not() {
    ! field "$1" Depends | grep -qE "$2" || fail "$1 depends on $2: $(field "$1" Depends)"
}
has() { # NAME PATTERN: a file
    local files
    files=$(dpkg-deb -c "${of[$1]}" | awk '{ print $6 }')
    grep -qE "$2" <<<"$files" || fail "$1 has no $2"
}
version=$(field haptel Version)
[[ $version == $so.*-1~[a-z]* ]] || fail "the version is $version"
exact="\(= ${version//./\\.}\)"
for name in $expected; do
    [[ $(field "$name" Version) == "$version" ]] || fail "$name has version $(field "$name" Version)"
    [[ $(field "$name" Maintainer) == *' <'*@*'>' ]] || fail "$name has maintainer $(field "$name" Maintainer)"
    [[ -n $(field "$name" Section) ]] || fail "$name has no section"
    (($(field "$name" Description | wc -l) > 2)) || fail "$name is not described"
    (($(field "$name" Description | awk '{ if (length > m) m = length } END { print m }') <= 80)) || fail "$name is described in long lines"
    has "$name" "^\./usr/share/doc/$name/copyright$"
    has "$name" "^\./usr/share/doc/$name/changelog.Debian.gz$"
    others=$(dpkg-deb -c "${of[$name]}" | grep -v '^d' | awk '{ print $6 }' | grep -v "^\./usr/share/doc/$name/") ||
        fail "$name is empty"
    case $name in
    haptel) allowed='(bin/haptel|share/man/man1/haptel\.1\.gz)$' ;;
    haptel-materials) allowed='share/haptel/libraries/materials/' ;;
    haptel-udev) allowed='lib/udev/rules\.d/' ;;
    python3-haptel) allowed='lib/python3/dist-packages/haptel\.py$' ;;
    libhaptel-compiler-dev) allowed='lib/.*(libhaptel_compiler\.so|HaptelCompilerTargets.*\.cmake|haptel-compiler\.pc)$' ;;
    libhaptel-dev) allowed='(include/haptel/|lib/.*(libhaptel\.so|Haptel(Config|Targets).*\.cmake|haptel_add_textures\.cmake|/haptel\.pc)$)' ;;
    *) allowed="lib/(.*/)?lib[a-z_]*\.so\.$so" ;; # nothing that another version has, too
    esac
    ! grep -vE "^\./usr/$allowed" <<<"$others" || fail "$name has files that belong elsewhere"
done
pages=$(dpkg-deb --fsys-tarfile "${of[haptel]}" | tar -xO ./usr/share/man/man1/haptel.1.gz | gzip -d)
for command in explore build install; do
    grep -qx "\.B $command" <<<"$pages" || fail "the manual page knows no $command"
done
needs "libhaptel$so" 'libc6 \('
needs "libhaptel$so" 'libusb-1'
needs "libhaptel-compiler$so" libllvm
needs_not "libhaptel$so" llvm
needs "libhaptel-compiler$so" "libhaptel$so $exact"
needs libhaptel-dev "libhaptel$so $exact"
needs_not libhaptel-dev 'compiler|llvm'
needs libhaptel-compiler-dev "libhaptel-compiler$so $exact"
needs libhaptel-compiler-dev "libhaptel-dev $exact"
needs python3-haptel "libhaptel-compiler$so"
for name in "libhaptel$so" "libhaptel-compiler$so"; do
    control=$(dpkg-deb --ctrl-tarfile "${of[$name]}" | tar -tf -)
    for part in shlibs triggers md5sums; do grep -q "/$part$" <<<"$control" || fail "$name has no $part"; done
    soname=$(dpkg-deb -I "${of[$name]}" shlibs | awk '{ print $1 ".so." $2 }')
    has "$name" "/$soname -> |/$soname$"
done
for name in haptel-materials haptel-udev python3-haptel; do
    [[ $(field "$name" Architecture) == all ]] || fail "$name is of one architecture"
done
echo "$(wc -w <<<"$expected") packages, version $version"
