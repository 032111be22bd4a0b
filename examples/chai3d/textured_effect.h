// A texture of Haptel on an object of CHAI3D, as one of its haptic effects. The texture was compiled when the program
// was: its entry is called from CHAI3D's haptic loop, and allocates, locks and throws nothing.
#pragma once

#include <haptel/abi.h>

#include <chai3d.h>

#include <algorithm>
#include <stdexcept>

// The force of a spring that pushes the tool out of the textured surface, against the gradient of how deep it is:
//     k (depth + height - highest) (normal - slope along the surface)
// So it rises from 0 where the tool enters the object, and on a frictionless object gives back what it took. The object
// has no other effect that pushes the tool out, such as cEffectSurface. Lengths of the world are metres.
class TexturedEffect : public chai3d::cGenericEffect {
public:
    // The block holds the values of the texture's parameters. No height is above highest_m with them.
    template <class Block>
    TexturedEffect(chai3d::cGenericObject* object, const haptel_texture& texture, const Block& block, double highest_m)
        : cGenericEffect(object), entry_(texture.height_gradient), block_(&block), highest_m_(highest_m)
    {
        if (texture.abi != HAPTEL_ABI_VERSION || !entry_) throw std::invalid_argument("a texture of another Haptel");
        const uint32_t known = HAPTEL_READS_POINT | HAPTEL_READS_CENTER | HAPTEL_READS_EXTENT | HAPTEL_READS_FOOTPRINT;
        if (texture.reads & ~known)
            throw std::invalid_argument("a texture that reads more than the point and its block");
    }

    bool computeForce(const chai3d::cVector3d& tool_m, const chai3d::cVector3d&, const unsigned int&,
                      chai3d::cVector3d& force_n) override
    {
        force_n.zero();
        if (!m_enabled || !m_parent->m_interactionInside) return false;
        const chai3d::cVector3d &at_m = m_parent->m_interactionPoint, &normal = m_parent->m_interactionNormal;
        haptel_point point{};
        haptel_sample sample{};
        double depth_m = 0, along_normal = 0;
        for (int axis = 0; axis < 3; ++axis) {
            point.p[axis] = at_m(axis);
            point.n[axis] = normal(axis);
            depth_m += (at_m(axis) - tool_m(axis)) * normal(axis);
        }
        entry_(&point, block_, &sample);
        for (int axis = 0; axis < 3; ++axis) along_normal += sample.gradient[axis] * normal(axis);
        const double pressed_m = std::max(0.0, depth_m + sample.height_m - highest_m_);
        const double push_n = m_parent->m_material->getStiffness() * pressed_m;
        for (int axis = 0; axis < 3; ++axis)
            force_n(axis) = push_n * (normal(axis) - (sample.gradient[axis] - along_normal * normal(axis)));
        return true;
    }

private:
    haptel_entry* entry_;
    const void* block_;
    double highest_m_;
};
