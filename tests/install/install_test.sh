#!/bin/sh
# install_test.sh SOURCE BUILD CMAKE COMPILER FLAGS: installs into a folder of its own, moves that elsewhere (a package
# is built in one place and used in another), builds examples/embed against it, runs it, and looks at its picture.
set -eu
source=$1
build=$2
cmake=$3
compiler=$4
flags=$5

work=$build/install-test
rm -rf "$work"
mkdir -p "$work"

"$cmake" --install "$build" --prefix "$work/staged"
mv "$work/staged" "$work/prefix"
test -x "$work/prefix/bin/alhazen"

# Only the public face is visible in the library: no symbol of a room is.
library=$(find "$work/prefix" -name 'libalhazen.so' | head -n 1)
exported=$(nm -DC --defined-only "$library")
echo "$exported" | grep -q ' T alhazen::SceneModel::render'
if echo "$exported" | grep -E ' [TBD] alhazen::' |
    grep -vE 'alhazen::(SceneModel|Picture|Pose|InputError|library_version|operator\*)'; then
    echo "The library shows what is not public."
    exit 1
fi

"$cmake" -G Ninja -S "$source/examples/embed" -B "$work/embed" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_PREFIX_PATH="$work/prefix" -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_FLAGS="$flags"
"$cmake" --build "$work/embed"

report=$("$work/embed/embed" "$work/embed.png")
echo "$report" | tail -n 2
echo "$report" | grep -q '320 x 240, 32 samples'
# The scene's mean is about 0.22; black or blown out is wrong.
echo "$report" | awk '/^mean/ { found = $2 > 0.05 && $2 < 2 } END { exit !found }'
test "$(head -c 4 "$work/embed.png" | tail -c 3)" = PNG
test "$(wc -c <"$work/embed.png")" -gt 5000

# What is wrong is said, and leaves nothing behind.
if "$work/embed/embed" "$work/no/such/folder.png" 2>"$work/error"; then
    echo "Writing into a missing folder succeeded."
    exit 1
fi
grep -q 'folder.png' "$work/error"
