#include "runtime/servo/recording.h"

#include "runtime/servo/trace_csv.h"
#include "runtime/servo/trace_log.h"

namespace haptel::runtime {

TraceResult read_trace(const std::filesystem::path& file)
{
    return is_trace_log(file) ? read_trace_log(file) : read_trace_csv(file);
}

} // namespace haptel::runtime
