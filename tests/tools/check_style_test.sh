#!/bin/sh
# Planted faults that tools/check_style must find, and look-alikes that it must not.
set -eu
root=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
. "$root/tests/tools/expect.sh"

check() { "$root/tools/check_style" "$work"; }
# file NAME: the standard input becomes the only file there is.
file() {
    rm -rf "$work"/*
    mkdir -p "$work/$(dirname "$1")"
    cat >"$work/$1"
}
# lines N: a function's body of N lines.
lines() { awk -v n="$1" 'BEGIN { for (i = 0; i < n; ++i) print "    ++x;" }'; }

# What looks like a fault and is none.
file src/base/good.h <<'E2'
/// Allowed: new things in a comment, printf(, std::cout.
#pragma once
#include "base/vec.h"
namespace alhazen {
struct Values {
    Values(const Values&) = delete;
    static void* operator new(std::size_t size);
    const char* text = "delete new int; exit(1) { {";
    char brace = '{';
    int million = 1'000'000;
    T* make(void* place) { return ::new (place) T(); }
    void leave() { scope.exit(); }
};
}
E2
succeeds_with 'Style: 1 files, no faults' check

{ printf 'int f(int x) {\n'; lines 58; printf '}\n'; } | file src/base/f.cpp
succeeds_with 'no faults' check
{ printf 'int f(int x) {\n'; lines 59; printf '}\n'; } | file src/base/f.cpp
fails_with 'src/base/f.cpp:1: function of 61 lines' check
{ printf 'namespace {\nclass A : B {\n  public:\n    A() : x{1}, y(2) {\n'; lines 70; printf '    }\n};\n}\n'; } | file src/base/f.cpp
fails_with 'f.cpp:4: function of 72 lines' check
{ printf 'struct S { int x; };\nS f(int x)\n    requires(true)\n{\n    if (x) {\n'; lines 70; printf '    }\n}\n'; } | file src/base/f.cpp
fails_with 'f.cpp:4: function of 74 lines' check
{ printf 'struct A {\n'; lines 70; printf '};\nconst int table[] = {\n'; lines 70; printf '};\n'; } | file src/base/f.cpp
succeeds_with 'no faults' check

lines 500 | file tests/unit/long.cpp
succeeds_with 'no faults' check
lines 501 | file tests/unit/long.cpp
fails_with 'long.cpp:1: file of 501 lines' check
lines 501 | file src/color/data/table.cpp
succeeds_with 'no faults' check

echo 'auto p = new int[3];' | file src/base/f.cpp
fails_with 'f.cpp:1: raw new' check
echo 'void f(int* p) { delete p; }' | file tests/unit/f.cpp
fails_with 'f.cpp:1: raw delete' check
for call in 'std::cout << 1' 'printf("x")' 'fmt::print("x")' 'std::fprintf(file, "x")'; do
    echo "void f() { $call; }" | file src/image/f.cpp
    fails_with 'f.cpp:1: prints' check
    echo "void f() { $call; }" | file src/cli/f.cpp
    succeeds_with 'no faults' check
done
for call in 'exit(1)' 'std::exit(1)' 'std::abort()' '_exit(2)'; do
    echo "void f() { $call; }" | file src/image/f.cpp
    fails_with 'f.cpp:1: ends the program' check
done

echo 'int x;' | file src/base/f.h
fails_with 'f.h:1: no #pragma once' check
fails_with 'f.h:1: the header does not open with a comment' check
printf '// The shapes.\nKIND(sphere)\n' | file src/shapes/list.h
succeeds_with 'no faults' check
printf 'int x; // TO%s\n' 'DO later' | file src/base/f.cpp
fails_with 'f.cpp:1: a note to oneself' check

finish
