// A grammar in EBNF: rule = a "b" { c } [ d ] ( e | f ) ; Sentences of it are derived at random, or recognised.
#pragma once

#include <map>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace haptel::lang::test {

class Ebnf {
public:
    // name, number and string are terminals without a rule.
    explicit Ebnf(const std::string& text);
    ~Ebnf();

    std::string mistakes() const; // names without a rule, what cannot be read; one per line
    std::vector<std::string> rules() const;
    bool is_word(const std::string& word) const
    {
        return words.count(word) > 0;
    } // stands in it between quotation marks

    // A random sentence, short where it would nest deep; the rules that were used are added to `used`.
    std::vector<std::string> derive(const std::string& rule, std::mt19937& random, std::set<std::string>& used) const;
    bool derives(const std::string& rule, const std::vector<std::string>& sentence) const;

    struct Node;

private:
    std::map<std::string, std::unique_ptr<Node>> by_name;
    std::set<std::string> words;
    std::string unread;
};

} // namespace haptel::lang::test
