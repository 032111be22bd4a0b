// Names that stand for something else than a file of a sensible size. What each is comes from POSIX; that nothing waits
// shows by the test's end.
#include "input/regular_file.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

#include <filesystem>
#include <string>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

using namespace haptel;
using namespace haptel::input;

namespace {

constexpr std::uintmax_t limit = 1000;

Refused refused(const std::filesystem::path& file)
{
    const FileBytes read = read_regular_file(file, limit);
    CHECK(read.bytes.empty());
    const Refused look = look_at_regular_file(file, limit);
    CHECK(look.refusal == read.refused.refusal);
    CHECK(look.why == read.refused.why);
    return read.refused;
}

} // namespace

TEST_CASE("regular file: its bytes, whatever they are, up to the limit")
{
    const test::Folder folder;
    for (const std::size_t size : {0u, 1u, 999u, 1000u}) {
        std::string bytes(size, '\0');
        for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i * 7);
        const FileBytes read = read_regular_file(folder.write("file", bytes), limit);
        CHECK(read.refused.refusal == Refusal::none);
        CHECK(read.bytes == bytes);
    }
    std::filesystem::create_symlink(folder.write("target", "far"), folder.path / "link");
    CHECK(read_regular_file(folder.path / "link", limit).bytes == "far");
}

TEST_CASE("regular file: what is none is refused by what it is, and nobody waits for it")
{
    const test::Folder folder;
    CHECK(refused(folder.path / "none").refusal == Refusal::missing);
    CHECK(refused(std::filesystem::path(folder.write("file", "x")) / "below").refusal == Refusal::missing);
    CHECK(refused(folder.path).refusal == Refusal::folder);
    CHECK(refused("/dev/zero").why == "is a device, not a regular file");
    CHECK(refused("/dev/zero").refusal == Refusal::not_regular);

    const std::string pipe = folder.file("pipe");
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    CHECK(refused(pipe).why == "is a pipe, not a regular file");
    std::filesystem::create_symlink(pipe, folder.path / "link");
    CHECK(refused(folder.path / "link").refusal == Refusal::not_regular);

    sockaddr_un address = {AF_UNIX, {}};
    folder.file("socket").copy(address.sun_path, sizeof address.sun_path - 1);
    const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
    REQUIRE(bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    CHECK(refused(folder.file("socket")).why == "is a socket, not a regular file");
    close(socket);
}

TEST_CASE("regular file: a size beyond the limit is refused before memory is taken, both sizes named")
{
    const test::Folder folder;
    CHECK(refused(folder.write("large", std::string(1001, 'x'))).why ==
          "has 1001 bytes, and at most 1000 bytes are read");
    const std::string sparse = folder.write("sparse", "");
    std::filesystem::resize_file(sparse, std::uintmax_t{1} << 42); // more than memory holds
    CHECK(refused(sparse).why == "has 4 TiB, and at most 1000 bytes are read");
    CHECK(read_regular_file(sparse, 16 << 20).refused.why == "has 4 TiB, and at most 16 MiB are read");
}

TEST_CASE("regular file: one that grows while it is read ends at the limit")
{
    const test::Folder folder;
    const std::string path = folder.write("file", std::string(900, 'x'));
    RegularFile file(path, limit);
    std::string bytes(4000, '\0');
    CHECK(file.read(bytes.data(), 500) == 500);
    std::filesystem::resize_file(path, 3000);
    CHECK(file.read(bytes.data(), bytes.size()) == 0);
    CHECK(file.refused().refusal == Refusal::too_large);
    // The system's own files say that they are empty.
    CHECK(!read_regular_file("/proc/self/status", 1 << 20).bytes.empty());
}
