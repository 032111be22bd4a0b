#include "tests/support/catch.h"
#include "tools/plot/plot_grid.h"

#include <cmath>

using haptel::tools::plot::exaggeration_for;

TEST_CASE("slopes are exaggerated until they are seen, by a round number, and by no more than 100 000")
{
    CHECK(exaggeration_for(0.3) == 1);
    CHECK(exaggeration_for(0.149) == 2);
    CHECK(exaggeration_for(0.059) == 5);
    CHECK(exaggeration_for(0.0299) == 10);
    CHECK(exaggeration_for(2.9e-6) == 1e5);
    CHECK(exaggeration_for(1e-12) == 1e5);
    CHECK(exaggeration_for(0) == 1); // there are none
    CHECK(exaggeration_for(NAN) == 1);
}
