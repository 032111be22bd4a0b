#include "libraries/package/archive.h"
#include "libraries/sha256.h"
#include "tests/libraries/library_text.h"
#include "tests/support/catch.h"
#include "tests/support/folder.h"

#include <sys/stat.h>

using namespace haptel;
using namespace haptel::libraries;
namespace fs = std::filesystem;

TEST_CASE("sums are those of SHA-256")
{
    // FIPS 180-2, appendix B.
    CHECK(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    CHECK(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

TEST_CASE("what is packed is read, and the same files give the same bytes")
{
    Contents files = test::library_files("wood", "1.0.0");
    files.insert({{"README.md", "# Wood\n"}, {"LICENSE", ""}, {"previews/oak/board.png", std::string("\x89PNG\0", 5)}});
    const Package package = make_package(files, "wood").package.value();
    const ArchiveResult archive = write_archive(package);
    CHECK(archive.error == "");
    CHECK(write_archive(package).bytes == archive.bytes);
    CHECK(archive.bytes.substr(10, 4) == std::string("\0\0\x21\0", 4)); // 1980-01-01 00:00, whatever the clock says
    const PackageResult read = read_archive(archive.bytes, "wood.haptlib");
    CHECK(read.messages == "");
    REQUIRE(read.package);
    CHECK(read.package->contents == package.contents);
    CHECK(read.package->manifest.name == "wood");
    files.insert(*read.package->contents.find(sums_name));
    CHECK(read.package->contents == files);
}

TEST_CASE("a folder is read with what belongs to a library, and refused where it holds something else")
{
    const haptel::test::Folder folder;
    const fs::path wood = folder.path / "wood";
    test::write_files(test::library_files("wood", "1.0.0"), wood);
    test::write_files({{".git/config", "x"}, {".hidden", "x"}, {"wood.haptlib", "x"}}, wood);
    CHECK(read_folder(wood).package.value().contents == test::library("wood", "1.0.0").contents);

    const auto said_with = [&](const std::string& path) {
        const fs::path file = wood / path;
        const std::string said = read_folder(wood).messages;
        fs::remove_all(file);
        INFO(said);
        CHECK(read_folder(wood).package);
        return said;
    };
    test::write_files({{"a.out", "x"}}, wood);
    CHECK(said_with("a.out") == wood.string() + ": error: 'a.out' is no file for a library: it holds *.haptel, *.toml, "
                                                "*.png, *.md, *.txt, LICENSE and NOTICE\n");
    test::write_files({{"Oak.haptel", "x"}}, wood);
    CHECK(said_with("Oak.haptel").find("small letters") != std::string::npos);
    fs::create_symlink("/etc/passwd", wood / "pine.haptel");
    CHECK(said_with("pine.haptel").find("'pine.haptel' is a link") != std::string::npos);
    fs::create_directory_symlink("/etc", wood / "etc");
    CHECK(said_with("etc").find("'etc' is a link") != std::string::npos);
    REQUIRE(mkfifo((wood / "pipe.haptel").c_str(), 0600) == 0);
    CHECK(said_with("pipe.haptel").find("no regular file") != std::string::npos);
    CHECK(read_folder(folder.path / "none").messages.find("cannot read this folder") != std::string::npos);
}
