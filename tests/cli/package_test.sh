#!/usr/bin/env bash
# The installed tree runs from where it was moved to, and the .deb unpacks to a tree that runs.
#
#   package_test.sh <build folder> <source folder> <version>
set -euo pipefail
build=$1 source=$2 version=$3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() { echo "package_test: $*" >&2; exit 1; }

# runs <program> <molecule>: it knows its version and draws.
runs() {
  local program=$1 molecule=$2 picture=$work/picture.png
  [[ $("$program" --version) == *"$version"* ]] || fail "$program --version does not say $version"
  rm -f "$picture"
  (cd / && "$program" render "$molecule" -o "$picture" --size 64x48 --representation spacefill >/dev/null)
  [[ $(head -c 8 "$picture" | od -An -tx1 | tr -d ' \n') == 89504e470d0a1a0a ]] || fail "$program wrote no PNG"
}

has() { [[ -s $1 ]] || fail "$1 is missing or empty"; }

cmake --install "$build" --prefix "$work/first" >"$work/log" || { cat "$work/log" >&2; fail "cmake --install"; }
mkdir "$work/elsewhere"
mv "$work/first" "$work/elsewhere/tree"
tree=$work/elsewhere/tree
has "$tree/share/doc/meniscus/LICENSE"
has "$tree/share/doc/meniscus/README.md"
has "$tree/share/meniscus/molecules/README.md"
runs "$tree/bin/meniscus" "$tree/share/meniscus/molecules/c60.pdb"
if grep --quiet --recursive --binary-files=without-match --fixed-strings "$source/" "$tree"; then
  fail "a text file of the installed tree names the source folder"
fi

cpack --config "$build/CPackConfig.cmake" -G DEB -B "$work/cpack" >"$work/log" 2>&1 ||
  { cat "$work/log" >&2; fail "cpack"; }
packages=("$work"/cpack/meniscus_"$version"_*.deb)
[[ ${#packages[@]} -eq 1 && -f ${packages[0]} ]] || fail "cpack made no meniscus_${version}_<architecture>.deb"
deb=${packages[0]}

field() { dpkg-deb --field "$deb" "$1"; }
[[ $(field Package) == meniscus ]] || fail "Package: $(field Package)"
[[ $(field Version) == "$version" ]] || fail "Version: $(field Version)"
[[ $(field Section) == science ]] || fail "Section: $(field Section)"
[[ $(field Architecture) == "$(dpkg --print-architecture)" ]] || fail "Architecture: $(field Architecture)"
[[ -n $(field Maintainer) && -n $(field Description) ]] || fail "no Maintainer or Description"
for package in libc6 libstdc++6 libegl1 libgl1-mesa-dri; do
  [[ $(field Depends) == *"$package"* ]] || fail "Depends lacks $package: $(field Depends)"
done
[[ $(field Recommends) == *libosmesa6* ]] || fail "Recommends: $(field Recommends)"

dpkg-deb -x "$deb" "$work/deb"
has "$work/deb/usr/share/doc/meniscus/copyright"
runs "$work/deb/usr/bin/meniscus" "$work/deb/usr/share/meniscus/molecules/c60.pdb"
echo "package_test: $(basename "$deb"): Depends: $(field Depends)"
