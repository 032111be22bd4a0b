// Expressions of random_source.h: of a given kind, from what is in scope.
#pragma once

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace haptel::fuzz {

enum class Kind : uint8_t { real, whole, word, truth, vec2, vec3, vec4, mat2, mat3, cell, words, truths };
inline constexpr uint64_t kinds = 12;
const char* type_of(Kind kind);

struct Variable {
    std::string name;
    Kind kind;
    bool assignable;
};

// Functions of the program by what they take: float(float, float), float(vec3), vec2(vec2), int(int, uint),
// bool(float), float(float[3], bool), float(float, out float, inout ivec3, float = ..).
enum class Shape : uint8_t { of_two, field, map, of_ints, test, of_array, writer };
struct Callable {
    std::string name;
    Shape shape;
};

class ExpressionWriter {
public:
    explicit ExpressionWriter(uint64_t seed) : random(seed) {}

protected:
    std::vector<Variable> scope;
    std::vector<Callable> callables;

    uint64_t below(uint64_t limit) { return random() % limit; }
    std::string one_of(std::initializer_list<std::string> texts) { return texts.begin()[below(texts.size())]; }
    std::string fresh() { return "v" + std::to_string(++names); }
    const Variable* any_variable(const std::function<bool(const Variable&)>& fits);

    // `depth` bounds how deep they nest.
    std::string of(Kind kind, int depth);
    std::string real(int depth);
    std::string tame(int depth); // a real that is not large, whatever it is made of
    std::string whole(int depth);
    std::string index(int size, int depth); // of an array of so many
    std::string word(int depth);
    std::string truth(int depth);
    std::string vector(int size, int depth);
    std::string matrix(int size, int depth);
    std::string cell(int depth);   // an ivec3
    std::string words(int depth);  // a uvec2
    std::string truths(int depth); // a bvec2
    std::string number();
    std::string whole_number();
    std::string swizzle(int from, int size); // ".xy", of a vector of `from` components
    const Callable* any_callable(Shape shape);
    std::string reals(int size, int depth); // a list of arguments

private:
    std::mt19937_64 random;
    int names = 0;

    std::string variable_or(Kind kind, const std::function<std::string()>& other);
    std::string choice(Kind kind, int depth);
    std::string real_of_parts(int depth);
    std::string real_of_calls(int depth);
};

} // namespace haptel::fuzz
