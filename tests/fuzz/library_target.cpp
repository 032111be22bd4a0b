// Files that claim to be texture libraries, their manifests and their locks.
#include "libraries/lock.h"
#include "libraries/package/archive.h"
#include "tests/fuzz/target.h"
#include "tests/libraries/library_text.h"

namespace haptel::fuzz {

void read_library(std::string_view bytes)
{
    using namespace libraries;
    const PackageResult read = read_archive(bytes, "x.haptlib");
    if (read.package.has_value() != read.messages.empty()) fail("neither a library nor a reason, or both");
    count(read.package ? "libraries" : "archives refused");
    if (read.package) {
        const ArchiveResult again = write_archive(*read.package);
        const PackageResult same = read_archive(again.bytes, "x.haptlib");
        if (!same.package || same.package->contents != read.package->contents)
            fail("packed again it is another library");
    }
    input::FileMessages of_manifest(manifest_name), of_lock(lock_name);
    const std::optional<Manifest> manifest = read_manifest(bytes, of_manifest);
    if (manifest.has_value() != of_manifest.text().empty()) fail("neither a manifest nor a reason, or both");
    if (manifest && (!is_library_name(manifest->name) || manifest->license.empty() || manifest->textures.empty()))
        fail("a manifest that lacks what it must have");
    const auto locked = read_lock(bytes, of_lock);
    if (locked.has_value() != of_lock.text().empty()) fail("neither a lock nor a reason, or both");
    if (locked) {
        input::FileMessages again(lock_name);
        const auto same = read_lock(lock_text(*locked), again);
        if (!same || same->size() != locked->size()) fail("written again it is another lock");
    }
    const bool leads_out = bytes.starts_with('/') || bytes.find("..") != bytes.npos || bytes.find('\\') != bytes.npos ||
                           bytes.find('\0') != bytes.npos || bytes.empty();
    if (leads_out && fault_of_path(bytes).empty()) fail("a path that leads out of the library");
}

std::vector<std::string> library_corpus()
{
    using namespace libraries;
    const std::string sum(64, 'a');
    return {write_archive(test::library("wood", "1.0.0")).bytes,
            test::manifest_text("wood", "1.0.0",
                                "haptel = \"0.1\"\nlanguage = 1\ntags = [\"a\"]\n[dependencies]\ngrain = \"2.1\"\n"),
            lock_text({{"wood", {1, 0, 0}, sum}, {"grain", {2, 1, 0}, sum}}), "previews/oak/board.png", "../x.haptel"};
}

} // namespace haptel::fuzz
