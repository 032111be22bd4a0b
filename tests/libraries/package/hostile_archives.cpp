#include "tests/libraries/package/hostile_archives.h"

#include "tests/libraries/library_text.h"
#include "tests/libraries/package/raw_zip.h"

#include <functional>

namespace haptel::test {

using namespace libraries;

namespace {

RawZip zip_of(const Contents& contents)
{
    RawZip zip;
    for (const auto& [path, bytes] : contents) zip.entries.push_back({path, bytes});
    return zip;
}

Contents sound()
{
    return library("wood", "1.0.0").contents;
}

// The sound library with one of its files, or one more, by name.
RawEntry& entry(RawZip& zip, const std::string& name)
{
    for (RawEntry& each : zip.entries)
        if (each.name == name) return each;
    zip.entries.push_back({name, "x"});
    return zip.entries.back();
}

class Collection {
public:
    std::vector<HostileArchive> all;

    void add(const std::string& what, const std::string& bytes, const std::string& said)
    {
        all.push_back({what, bytes, said});
    }
    void changed(const std::string& what, const std::string& said, const std::function<void(RawZip&)>& change)
    {
        RawZip zip = zip_of(sound());
        change(zip);
        add(what, zip.bytes(), said);
    }
    // With sums that are right.
    void of_files(const std::string& what, const std::string& said, const std::function<void(Contents&)>& change)
    {
        Contents contents = sound();
        change(contents);
        contents[sums_name] = sums_of(contents);
        add(what, zip_of(contents).bytes(), said);
    }
};

void add_paths(Collection& to)
{
    const std::string no_path = "cannot be the path of a library's file", no_kind = "is no file for a library";
    for (const char* const path : {"../evil.haptel",
                                   "a/../../evil.haptel",
                                   "/etc/evil.haptel",
                                   "//evil.haptel",
                                   "./oak2.haptel",
                                   "a/./b.haptel",
                                   "a//b.haptel",
                                   "..\\evil.haptel",
                                   "a\\..\\..\\evil.haptel",
                                   "c:evil.haptel",
                                   "C:\\evil.haptel",
                                   "\\\\host\\evil.haptel",
                                   "Oak.haptel",
                                   "OAK.haptel",
                                   "o\xcc\x81k.haptel",
                                   "\xc3\xb3k.haptel",
                                   "\xef\xbc\x8e\xef\xbc\x8e/evil.haptel",
                                   "oak\xe2\x80\xaelepath.haptel",
                                   "oak\xe2\x80\x8b.haptel",
                                   "\xff\xfe.haptel",
                                   "..\xc0\xaf.haptel",
                                   "a\nb.haptel",
                                   "\x1b[2Jx.haptel",
                                   "a b.haptel",
                                   ".hidden.haptel",
                                   ".haptel",
                                   "~/x.haptel",
                                   "$(reboot).haptel",
                                   "-rf.haptel",
                                   "nul:.haptel",
                                   "oak*.haptel",
                                   "library.toml/x.haptel",
                                   "oak.haptel.haptel"})
        to.changed(std::string("the path ") + path, no_path, [&](RawZip& zip) { entry(zip, path); });
    for (const char* const path :
         {"evil.so", "evil.sh", "evil", "oak.HAPTEL", "oak.haptel.", "oak.haptel ", "makefile"})
        to.changed(std::string("the path ") + path, "", [&](RawZip& zip) { entry(zip, path); });
    to.changed("a folder", "", [](RawZip& zip) { entry(zip, "folder/").data = ""; });
    to.changed("no name", "", [](RawZip& zip) { entry(zip, ""); });
    to.changed("a name that ends before its end", "",
               [](RawZip& zip) { entry(zip, std::string("x.haptel\0.png", 13)); });
    to.changed("a long name", "too long a path", [](RawZip& zip) { entry(zip, std::string(60'000, 'a') + ".haptel"); });
    to.changed("many folders", "too deep", [](RawZip& zip) {
        std::string path;
        for (int i = 0; i < 20; ++i) path += "a/";
        entry(zip, path + "b.haptel");
    });
}

void add_kinds(Collection& to)
{
    const std::string no_file = "'oak.haptel' is a link, a folder or no regular file";
    for (const uint32_t mode : {0120777u, 0040755u, 0020666u, 0060666u, 0010644u, 0140755u, 0u})
        to.changed("a file of mode " + std::to_string(mode), no_file,
                   [&](RawZip& zip) { entry(zip, "oak.haptel").attributes = mode << 16; });
    to.changed("a link out of the library", "is a link", [](RawZip& zip) {
        entry(zip, "oak.haptel").attributes = 0120777u << 16;
        entry(zip, "oak.haptel").data = "/etc/passwd";
    });
    to.changed("attributes of another system", no_file, [](RawZip& zip) { entry(zip, "oak.haptel").system = 0; });
    for (const int method : {8, 9, 12, 14, 93, 99})
        to.changed("compressed by method " + std::to_string(method), "",
                   [&](RawZip& zip) { entry(zip, "oak.haptel").method = static_cast<uint16_t>(method); });
    to.changed("few bytes that stand for many", "is compressed", [](RawZip& zip) {
        RawEntry& bomb = entry(zip, "oak.haptel");
        bomb.method = 8;
        bomb.size = 0xfffffffe;
    });
    to.changed("encrypted", "", [](RawZip& zip) { entry(zip, "oak.haptel").flags = 1; });
    to.changed("a file twice", "", [](RawZip& zip) { zip.entries.push_back(entry(zip, "oak.haptel")); });
    to.changed("two manifests", "",
               [](RawZip& zip) { zip.entries.push_back({"library.toml", manifest_text("other", "9.0.0")}); });
}

void add_sums(Collection& to)
{
    to.changed("no sums", "it has no SHA256SUMS", [](RawZip& zip) {
        std::erase_if(zip.entries, [](const RawEntry& one) { return one.name == sums_name; });
    });
    to.changed("a changed file", "'oak.haptel' is not the file that SHA256SUMS tells of",
               [](RawZip& zip) { entry(zip, "oak.haptel").data += " "; });
    to.changed("a file without a sum", "'pine.haptel' is not named", [](RawZip& zip) { entry(zip, "pine.haptel"); });
    to.changed("a sum without a file", "SHA256SUMS does not tell of these files", [](RawZip& zip) {
        std::erase_if(zip.entries, [](const RawEntry& one) { return one.name == "oak.haptel"; });
    });
    to.changed("empty sums", "is not named", [](RawZip& zip) { entry(zip, sums_name).data = ""; });
    to.changed("sums of zeros", "is not the file that SHA256SUMS tells of", [](RawZip& zip) {
        entry(zip, sums_name).data =
            std::string(64, '0') + "  library.toml\n" + std::string(64, '0') + "  oak.haptel\n";
    });
    to.changed("sums with a path out of it", "SHA256SUMS does not tell of these files",
               [](RawZip& zip) { entry(zip, sums_name).data += std::string(64, '0') + "  ../../.bashrc\n"; });
}

void add_structure(Collection& to)
{
    const std::string damaged = "damaged", cut = "its end is missing, or something stands behind it";
    to.changed("a wrong checksum", damaged, [](RawZip& zip) { entry(zip, "oak.haptel").crc = 7; });
    to.changed("two names", damaged, [](RawZip& zip) { entry(zip, "oak.haptel").local_name = "../x.haptel"; });
    to.changed("two sizes", damaged, [](RawZip& zip) { entry(zip, "oak.haptel").local_size = 3; });
    to.changed("a size beyond the end", "",
               [](RawZip& zip) { entry(zip, "oak.haptel").size = entry(zip, "oak.haptel").packed_size = 1'000'000; });
    to.changed("a size of 4 GiB", "",
               [](RawZip& zip) { entry(zip, "oak.haptel").size = entry(zip, "oak.haptel").packed_size = 0xffffffff; });
    to.changed("a file inside of another", "", [](RawZip& zip) { entry(zip, "oak.haptel").offset = 0; });
    to.changed("a file behind the end", "", [](RawZip& zip) { entry(zip, "oak.haptel").offset = 0x7fffffff; });
    to.changed("a directory elsewhere", "", [](RawZip& zip) { zip.directory_offset = 0; });
    to.changed("a directory behind the end", "", [](RawZip& zip) { zip.directory_offset = 0x7fffffff; });
    to.changed("a long directory", "", [](RawZip& zip) { zip.directory_size = 0x7fffffff; });
    to.changed("more files than there are", "", [](RawZip& zip) { zip.count = 100; });
    to.changed("fewer files than there are", "", [](RawZip& zip) { zip.count = 1; });
    to.changed("files without number", "it has more than 4096 files", [](RawZip& zip) { zip.count = 65535; });
    to.changed("a comment", cut, [](RawZip& zip) { zip.comment = "#!/bin/sh"; });
    to.changed("something behind", cut, [](RawZip& zip) { zip.behind = "x"; });
    to.changed("something before", "it is no .haptlib", [](RawZip& zip) { zip.before = "#!/bin/sh\n"; });
    to.changed("a name in another field", "", [](RawZip& zip) {
        // Info-ZIP's field for names in Unicode, for a name that is plain.
        const std::string name = "oak.haptel", other = "../x.haptel", id = "\x75\x70";
        const uint32_t crc = crc32_of(name);
        std::string body(1, '\1');
        for (int i = 0; i < 4; ++i) body += static_cast<char>(crc >> (8 * i) & 255);
        body += other;
        entry(zip, name).extra = id + static_cast<char>(body.size()) + '\0' + body;
        entry(zip, name).data += " "; // what an unwary reader would write there
    });
    const std::string whole = zip_of(sound()).bytes();
    for (const size_t part : {1, 4, 10, 50, 90, 99})
        to.add("cut at " + std::to_string(part) + " %", whole.substr(0, whole.size() * part / 100), "");
    to.add("without its first byte", whole.substr(1), "it is no .haptlib");
    to.add("nothing", "", "it is no .haptlib");
    to.add("words", "schema = 1\n", "it is no .haptlib");
    to.add("an archive of no files", "PK\5\6" + std::string(18, '\0'), "it is no .haptlib");
    to.add("gzip", "\x1f\x8b\x08" + std::string(100, '\0'), "it is no .haptlib");
    to.add("tar", "library.toml" + std::string(1012, '\0'), "it is no .haptlib");
    to.add("a program",
           "\x7f"
           "ELF" +
               std::string(100, '\2'),
           "it is no .haptlib");
}

void add_manifests(Collection& to)
{
    const auto with = [&](const std::string& what, const std::string& said, const std::string& text) {
        to.of_files(what, said, [&](Contents& contents) { contents[manifest_name] = text; });
    };
    to.of_files("no manifest", "it has no library.toml", [](Contents& contents) { contents.erase(manifest_name); });
    to.of_files("no texture file", "and there is no file oak.haptel",
                [](Contents& contents) { contents.erase("oak.haptel"); });
    with("no TOML", "library.toml:1:", "]]]]");
    with("deep TOML", "nest deeper", "a = " + std::string(200'000, '['));
    with("no UTF-8", "library.toml:1:", "name = \"\xff\xfe\"\n");
    with("an empty manifest", "`license` is missing", "");
    with("a name with a path", "expected a name of small letters", manifest_text("../../evil", "1.0.0"));
    with("a version with a path", "expected three numbers", manifest_text("wood", "1.0.0/../../.."));
    with("a schema of tomorrow", "this Haptel reads schema 1",
         "schema = 2\n" + manifest_text("wood", "1.0.0").substr(11));
    with("a Haptel of tomorrow", "it needs Haptel 99.0.0", manifest_text("wood", "1.0.0", "haptel = \"99\"\n"));
    with("a language of tomorrow", "version 99 of the language", manifest_text("wood", "1.0.0", "language = 99\n"));
    with("an unknown key", "unknown key `post_install`", manifest_text("wood", "1.0.0", "post_install = \"reboot\"\n"));
    to.changed("a large file", "has more than 16 MiB",
               [](RawZip& zip) { entry(zip, "large.md").data = std::string(file_bytes_max + 1, 'x'); });
    to.changed("many files", "it has more than 4096 files", [](RawZip& zip) {
        for (size_t i = 0; i < files_max; ++i) zip.entries.push_back({"f" + std::to_string(i) + ".md", ""});
    });
}

} // namespace

std::vector<HostileArchive> hostile_archives()
{
    Collection made;
    add_paths(made);
    add_kinds(made);
    add_sums(made);
    add_structure(made);
    add_manifests(made);
    return std::move(made.all);
}

std::string sound_archive()
{
    return zip_of(sound()).bytes();
}

} // namespace haptel::test
