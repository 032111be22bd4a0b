#include "tests/lang/syntax/ebnf.h"

#include <algorithm>
#include <sstream>

namespace haptel::lang::test {

struct Ebnf::Node {
    enum class Kind { word, name, sequence, choice, repeated, optional } kind = Kind::sequence;
    std::string text; // of a word or name
    std::vector<std::unique_ptr<Node>> parts;
    size_t depth = 0; // of the flattest derivation; 0: not known yet
};

namespace {

using Node = Ebnf::Node;
using NodePtr = std::unique_ptr<Node>;

const std::set<std::string> classes = {"name", "number", "string"};

NodePtr make(Node::Kind kind, std::string text = {})
{
    auto node = std::make_unique<Node>();
    node->kind = kind;
    node->text = std::move(text);
    return node;
}

class Reader {
public:
    Reader(std::vector<std::string> all, std::set<std::string>& found) : symbols(std::move(all)), words(found) {}
    bool done() const { return at >= symbols.size(); }
    std::string next() { return done() ? "" : symbols[at++]; }

    NodePtr choice()
    {
        NodePtr node = make(Node::Kind::choice);
        do node->parts.push_back(sequence());
        while (accept("|"));
        return node;
    }

private:
    bool accept(const std::string& symbol)
    {
        const bool here = !done() && symbols[at] == symbol;
        at += here;
        return here;
    }

    NodePtr sequence()
    {
        NodePtr node = make(Node::Kind::sequence);
        const std::set<std::string> ends = {"|", ";", ")", "]", "}"};
        while (!done() && ends.count(symbols[at]) == 0) node->parts.push_back(single());
        return node;
    }

    NodePtr single()
    {
        const std::string symbol = next();
        if (symbol == "(" || symbol == "[" || symbol == "{") {
            NodePtr inner = choice();
            next(); // its closer
            if (symbol == "(") return inner;
            NodePtr node = make(symbol == "[" ? Node::Kind::optional : Node::Kind::repeated);
            node->parts.push_back(std::move(inner));
            return node;
        }
        if (symbol[0] != '"') return make(Node::Kind::name, symbol);
        const std::string word = symbol.substr(1, symbol.size() - 2);
        words.insert(word);
        return make(Node::Kind::word, word);
    }

    std::vector<std::string> symbols;
    std::set<std::string>& words;
    size_t at = 0;
};

using Rules = std::map<std::string, NodePtr>;

// Of the flattest derivation, as far as it is known; 0: not yet.
size_t depth_of(const Node& node, const Rules& rules)
{
    switch (node.kind) {
    case Node::Kind::word: return 1;
    case Node::Kind::repeated:
    case Node::Kind::optional: return 1;
    case Node::Kind::name: {
        if (classes.count(node.text) > 0) return 1;
        const auto found = rules.find(node.text);
        return found == rules.end() || found->second->depth == 0 ? 0 : found->second->depth + 1;
    }
    case Node::Kind::sequence: {
        size_t deepest = 1;
        for (const NodePtr& part : node.parts) {
            const size_t depth = depth_of(*part, rules);
            if (depth == 0) return 0;
            deepest = std::max(deepest, depth);
        }
        return deepest;
    }
    case Node::Kind::choice: {
        size_t flattest = 0;
        for (const NodePtr& part : node.parts) {
            const size_t depth = depth_of(*part, rules);
            if (depth > 0 && (flattest == 0 || depth < flattest)) flattest = depth;
        }
        return flattest;
    }
    }
    return 0;
}

void unknown_names(const Node& node, const Rules& rules, std::string& unknown)
{
    if (node.kind == Node::Kind::name && rules.count(node.text) == 0 && classes.count(node.text) == 0)
        unknown += node.text + "\n";
    for (const NodePtr& part : node.parts) unknown_names(*part, rules, unknown);
}

class Deriver {
public:
    Deriver(const Rules& all, std::mt19937& source, std::set<std::string>& seen)
        : rules(all), random(source), used(seen)
    {
    }
    std::vector<std::string> sentence;

    void derive(const Node& node, size_t depth)
    {
        const bool enough = depth > 45 || sentence.size() > 400;
        switch (node.kind) {
        case Node::Kind::word: sentence.push_back(node.text); return;
        case Node::Kind::name:
            if (classes.count(node.text) > 0) {
                sentence.push_back(node.text);
            } else {
                used.insert(node.text);
                derive(*rules.at(node.text), depth + 1);
            }
            return;
        case Node::Kind::sequence:
            for (const NodePtr& part : node.parts) derive(*part, depth);
            return;
        case Node::Kind::optional:
            if (!enough && random() % 2 == 0) derive(*node.parts.front(), depth);
            return;
        case Node::Kind::repeated:
            while (!enough && sentence.size() < 400 &&
                   random() % (depth < 3   ? 6
                               : depth < 6 ? 3
                                           : 8) >
                       (depth < 6 ? 0u : 6u))
                derive(*node.parts.front(), depth);
            return;
        case Node::Kind::choice: {
            std::vector<const Node*> open;
            size_t flattest = SIZE_MAX;
            for (const NodePtr& part : node.parts) flattest = std::min(flattest, depth_of(*part, rules));
            for (const NodePtr& part : node.parts)
                if (!enough || depth_of(*part, rules) == flattest) open.push_back(part.get());
            derive(*open[random() % open.size()], depth);
            return;
        }
        }
    }

private:
    const Rules& rules;
    std::mt19937& random;
    std::set<std::string>& used;
};

// Where a derivation that begins at a place can end: all places, each rule and place worked out once.
class Recogniser {
public:
    Recogniser(const Rules& all, const std::vector<std::string>& text) : rules(all), sentence(text) {}

    std::set<size_t> ends(const Node& node, size_t begin)
    {
        const auto here = [&](const std::string& word) { return begin < sentence.size() && sentence[begin] == word; };
        switch (node.kind) {
        case Node::Kind::word: return here(node.text) ? std::set<size_t>{begin + 1} : std::set<size_t>{};
        case Node::Kind::name: {
            if (classes.count(node.text) > 0) return here(node.text) ? std::set<size_t>{begin + 1} : std::set<size_t>{};
            const auto key = std::make_pair(node.text, begin);
            if (const auto known = memo.find(key); known != memo.end()) return known->second;
            return memo[key] = ends(*rules.at(node.text), begin);
        }
        case Node::Kind::sequence: {
            std::set<size_t> places{begin};
            for (const NodePtr& part : node.parts) {
                std::set<size_t> next;
                for (const size_t place : places) next.merge(ends(*part, place));
                places = std::move(next);
            }
            return places;
        }
        case Node::Kind::choice: {
            std::set<size_t> places;
            for (const NodePtr& part : node.parts) places.merge(ends(*part, begin));
            return places;
        }
        case Node::Kind::optional: {
            std::set<size_t> places = ends(*node.parts.front(), begin);
            places.insert(begin);
            return places;
        }
        case Node::Kind::repeated: {
            std::set<size_t> places{begin}, fresh{begin};
            while (!fresh.empty()) {
                std::set<size_t> next;
                for (const size_t place : fresh)
                    for (const size_t end : ends(*node.parts.front(), place))
                        if (places.insert(end).second) next.insert(end);
                fresh = std::move(next);
            }
            return places;
        }
        }
        return {};
    }

private:
    const Rules& rules;
    const std::vector<std::string>& sentence;
    std::map<std::pair<std::string, size_t>, std::set<size_t>> memo;
};

} // namespace

Ebnf::Ebnf(const std::string& text)
{
    std::istringstream stream(text);
    std::vector<std::string> symbols;
    for (std::string symbol; stream >> symbol;) symbols.push_back(symbol);
    Reader reader(symbols, words);
    while (!reader.done()) {
        const std::string name = reader.next(), equals = reader.next();
        NodePtr right = reader.choice();
        if (equals != "=" || reader.next() != ";") unread += "rule " + name + "\n";
        by_name[name] = std::move(right);
    }
    for (size_t round = 0; round < by_name.size(); ++round)
        for (auto& [name, node] : by_name)
            if (node->depth == 0) node->depth = depth_of(*node, by_name);
}

Ebnf::~Ebnf() = default;

std::string Ebnf::mistakes() const
{
    std::string all = unread;
    for (const auto& [name, node] : by_name) unknown_names(*node, by_name, all);
    return all;
}

std::vector<std::string> Ebnf::rules() const
{
    std::vector<std::string> names;
    for (const auto& [name, node] : by_name) names.push_back(name);
    return names;
}

std::vector<std::string> Ebnf::derive(const std::string& rule, std::mt19937& random, std::set<std::string>& used) const
{
    Deriver deriver(by_name, random, used);
    used.insert(rule);
    deriver.derive(*by_name.at(rule), 0);
    return deriver.sentence;
}

bool Ebnf::derives(const std::string& rule, const std::vector<std::string>& sentence) const
{
    return Recogniser(by_name, sentence).ends(*by_name.at(rule), 0).count(sentence.size()) > 0;
}

} // namespace haptel::lang::test
