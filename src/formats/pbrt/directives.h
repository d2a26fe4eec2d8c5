/// Which directives pbrt-v4's language has. To add one: a line in directives.cpp and a function of the
/// builder.
#pragma once

#include "formats/pbrt/parser.h"

namespace alhazen {

/// The directives: each word, and how what follows it is read and used.
struct DirectiveTable {
    using P = PbrtParser;
    using B = PbrtBuilder;
    struct Entry {
        std::string_view word;
        void (*run)(P& p, B& b, Place at);
    };

    /// A directive that is a type in quotes and parameters.
    template <void (B::*use)(Node, Place)>
    static void with_node(P& p, B& b, Place at) {
        Node node = p.node(at);
        (b.*use)(std::move(node), std::move(at));
    }
    template <void (B::*use)(const std::string&, Place)>
    static void with_name(P& p, B& b, Place at) {
        std::string name = p.string("a name");
        (b.*use)(name, std::move(at));
    }
    template <void (B::*use)(std::string, Place)>
    static void with_own_name(P& p, B& b, Place at) {
        std::string name = p.string("a name");
        (b.*use)(std::move(name), std::move(at));
    }
    template <void (B::*use)(Place)>
    static void alone(P&, B& b, Place at) {
        (b.*use)(std::move(at));
    }

    static const std::vector<Entry> entries; ///< in alphabetical order
    /// nullptr for a word that is no directive.
    static const Entry* find(std::string_view word);
};

} // namespace alhazen
