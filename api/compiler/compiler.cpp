#include "api/texture_source.h"
#include "jit/live/live_texture.h"
#include "jit/texture/resolver.h"

#include <haptel/compiler.h>

#include <utility>

namespace haptel {

namespace {

class CompiledTexture final : public FollowedTexture {
public:
    CompiledTexture(TextureRequest request, jit::LiveCallbacks callbacks)
        : texture_(std::move(request), std::move(callbacks))
    {
    }
    void set(const std::string& parameter, const std::string& value) override
    {
        texture_.set_parameter(parameter, value);
    }

private:
    jit::LiveTexture texture_;
};

} // namespace

TextureSource compiler(CompilerOptions options)
{
    auto source = std::make_shared<TextureSource::Implementation>();
    source->resolve = jit::make_resolver();
    source->rebind = jit::make_rebinder();
    if (options.follow_files)
        source->follow = [report = std::move(options.report)](TextureRequest request,
                                                              std::function<std::string(TextureBinding)> publish) {
            const auto say = [report](std::string_view text) {
                if (report && !text.empty()) report(text);
            };
            jit::LiveCallbacks callbacks;
            callbacks.publish = [publish = std::move(publish), say](TextureBinding binding) {
                say(publish(std::move(binding)));
            };
            callbacks.report = say;
            return std::make_unique<CompiledTexture>(std::move(request), std::move(callbacks));
        };
    return TextureSource(std::move(source));
}

} // namespace haptel
