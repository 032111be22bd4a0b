// A text as the only source.
#pragma once

#include "lang/text/source.h"

#include <string>
#include <utility>

inline haptel::lang::SourceSet one_source(std::string text)
{
    haptel::lang::SourceSet sources;
    sources.add({"t.haptel", std::move(text)});
    return sources;
}
