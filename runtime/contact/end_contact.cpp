#include "runtime/contact/end_contact.h"

#include "runtime/contact/sphere_contact.h"
#include "runtime/contact/walk_contact.h"

namespace haptel::runtime {

std::unique_ptr<EndContact> make_point(const std::shared_ptr<const Surface>& surface)
{
    if (surface->is_clean()) return std::make_unique<WalkContact>(surface);
    return std::make_unique<SphereContact>(surface);
}

} // namespace haptel::runtime
