// As much of CHAI3D 3.3 as examples/chai3d uses, to compile and try it where there is no CHAI3D: names and signatures
// are those of its documentation. A ball, a point that touches it, and a device whose hand goes in and round.
#pragma once

#include <chrono>
#include <cmath>
#include <memory>
#include <vector>

namespace chai3d {

class cVector3d {
public:
    cVector3d(double x = 0, double y = 0, double z = 0) : values_{x, y, z} {}
    double& operator()(int axis) { return values_[axis]; }
    double operator()(int axis) const { return values_[axis]; }
    void zero() { *this = cVector3d(); }
    double length() const { return std::hypot(values_[0], values_[1], values_[2]); }

private:
    double values_[3];
};

class cMaterial {
public:
    void setStiffness(double n_per_m) { n_per_m_ = n_per_m; }
    double getStiffness() const { return n_per_m_; }

private:
    double n_per_m_ = 0;
};
using cMaterialPtr = std::shared_ptr<cMaterial>;

class cGenericObject;

class cGenericEffect {
public:
    explicit cGenericEffect(cGenericObject* parent) : m_parent(parent) {}
    virtual ~cGenericEffect() = default;
    virtual bool computeForce(const cVector3d&, const cVector3d&, const unsigned int&, cVector3d& force)
    {
        force.zero();
        return false;
    }
    void setEnabled(bool enabled) { m_enabled = enabled; }
    cGenericObject* m_parent;

protected:
    bool m_enabled = true;
};

class cGenericObject {
public:
    virtual ~cGenericObject()
    {
        for (cGenericEffect* effect : m_effects) delete effect;
        for (cGenericObject* child : m_children) delete child;
    }
    bool addChild(cGenericObject* child) { return m_children.push_back(child), true; }
    bool addEffect(cGenericEffect* effect) { return m_effects.push_back(effect), effect->m_parent == this; }
    void computeGlobalPositions(bool) {}
    virtual void computeLocalInteraction(const cVector3d&, const cVector3d&, unsigned int) {}

    cMaterialPtr m_material = std::make_shared<cMaterial>();
    cVector3d m_interactionPoint, m_interactionNormal;
    bool m_interactionInside = false;
    std::vector<cGenericEffect*> m_effects;
    std::vector<cGenericObject*> m_children;
};
class cWorld : public cGenericObject {};

class cShapeSphere : public cGenericObject {
public:
    explicit cShapeSphere(double radius) : radius_(radius) {}
    void computeLocalInteraction(const cVector3d& tool, const cVector3d&, unsigned int) override
    {
        const double length = tool.length();
        m_interactionInside = length < radius_;
        for (int axis = 0; axis < 3; ++axis) {
            m_interactionNormal(axis) = tool(axis) / length;
            m_interactionPoint(axis) = tool(axis) / length * radius_;
        }
    }

private:
    double radius_;
};

struct cGenericHapticDevice {};
using cGenericHapticDevicePtr = std::shared_ptr<cGenericHapticDevice>;
class cHapticDeviceHandler {
public:
    bool getDevice(cGenericHapticDevicePtr& device, unsigned int)
    {
        device = std::make_shared<cGenericHapticDevice>();
        return true;
    }
};

class cToolCursor : public cGenericObject {
public:
    explicit cToolCursor(cWorld* world) : world_(world) {}
    void setHapticDevice(cGenericHapticDevicePtr) {}
    void setWorkspaceRadius(double) {}
    void setRadius(double) {}
    void setWaitForSmallForce(bool) {}
    bool start() { return true; }
    bool stop() { return true; }
    void updateFromDevice() // from 42 mm above the middle of a ball of 40 mm to 38 mm, and then round it
    {
        const double deep = std::fmin(1.0, ++ticks_ / 1000.0), angle = 1e-5 * ticks_;
        at_ = cVector3d((0.042 - 0.004 * deep) * std::sin(angle), 0, (0.042 - 0.004 * deep) * std::cos(angle));
    }
    void computeInteractionForces()
    {
        force_.zero();
        for (cGenericObject* object : world_->m_children) {
            object->computeLocalInteraction(at_, cVector3d(), 0);
            for (cGenericEffect* effect : object->m_effects) {
                cVector3d force;
                effect->computeForce(at_, cVector3d(), 0, force);
                for (int axis = 0; axis < 3; ++axis) force_(axis) += force(axis);
            }
        }
    }
    void applyToDevice() {}
    cVector3d getDeviceGlobalForce() const { return force_; }

private:
    cWorld* world_;
    cVector3d at_, force_;
    int ticks_ = 0;
};

class cPrecisionClock {
public:
    void start() { began_ = std::chrono::steady_clock::now(); }
    double getCurrentTimeSeconds() const
    {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    }

private:
    std::chrono::steady_clock::time_point began_;
};

} // namespace chai3d
