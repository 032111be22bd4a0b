// What `haptel test` found out about each texture, as a table, as JSON and as JUnit's XML.
#pragma once

#include "jit/check/check_gradient.h"
#include "tools/output/json.h"
#include "tools/report/amplified_place.h"

#include <optional>
#include <string>
#include <vector>

namespace haptel::tools {

struct TestedTexture {
    std::string file, name;                  // name empty: the file did not compile
    std::optional<jit::GradientCheck> check; // none: not reached
    std::string fault;                       // why it was not; empty: it was
    double seconds = 0;
    std::optional<AmplifiedPlace> amplified = {}; // with check->amplified

    bool passed() const { return check && check->passed(); }
};

struct TestReport {
    std::vector<TestedTexture> textures;

    size_t passed() const;
    size_t failed() const { return textures.size() - passed(); }

    Json to_json() const;
    std::string to_table() const;
    std::string to_junit() const;
};

} // namespace haptel::tools
