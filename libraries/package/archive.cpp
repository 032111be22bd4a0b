#include "libraries/package/archive.h"

#include "input/regular_file.h"

#include <memory>
#include <sys/stat.h>

#include <zip.h>

namespace haptel::libraries {

namespace {

struct ZipError : zip_error_t {
    ZipError() { zip_error_init(this); }
    ~ZipError() { zip_error_fini(this); }
    ZipError(const ZipError&) = delete;
    ZipError& operator=(const ZipError&) = delete;
    std::string text() { return zip_error_strerror(this); }
};

struct DiscardZip {
    void operator()(zip_t* archive) const { zip_discard(archive); }
};
using Zip = std::unique_ptr<zip_t, DiscardZip>;

struct CloseEntry {
    void operator()(zip_file_t* entry) const { zip_fclose(entry); }
};

struct FreeSource {
    void operator()(zip_source_t* source) const { zip_source_free(source); }
};
using Source = std::unique_ptr<zip_source_t, FreeSource>;

// 1980-01-01 00:00, the first that a ZIP archive can tell of.
constexpr zip_uint16_t first_time = 0, first_date = (1 << 5) | 1;
constexpr zip_uint32_t plain_file = (S_IFREG | 0644u) << 16;

std::string add(zip_t* archive, const std::string& path, const std::string& bytes)
{
    zip_source_t* const source = zip_source_buffer(archive, bytes.data(), bytes.size(), 0);
    const zip_int64_t index = source ? zip_file_add(archive, path.c_str(), source, 0) : -1;
    if (index < 0 && source) zip_source_free(source);
    const auto entry = static_cast<zip_uint64_t>(index);
    const bool is_added = index >= 0 && zip_set_file_compression(archive, entry, ZIP_CM_STORE, 0) == 0 &&
                          zip_file_set_dostime(archive, entry, first_time, first_date, 0) == 0 &&
                          zip_file_set_external_attributes(archive, entry, 0, ZIP_OPSYS_UNIX, plain_file) == 0;
    return is_added ? "" : zip_error_strerror(zip_get_error(archive));
}

std::string bytes_of(zip_source_t* source)
{
    zip_stat_t about;
    if (zip_source_stat(source, &about) != 0 || zip_source_open(source) != 0) return {};
    std::string bytes(about.size, '\0');
    const zip_int64_t count = zip_source_read(source, bytes.data(), bytes.size());
    zip_source_close(source);
    return count == static_cast<zip_int64_t>(bytes.size()) ? bytes : "";
}

// What there is to say before a reader of ZIP sees the bytes: its own end is there, with nothing behind it, and tells
// of no more files than there may be.
std::string fault_of_ends(std::string_view bytes)
{
    constexpr std::size_t end_size = 22;
    constexpr std::string_view first = "PK\3\4", last = "PK\5\6";
    if (!bytes.starts_with(first) || bytes.size() < end_size) return "it is no .haptlib, which haptel pack makes";
    const std::string_view end = bytes.substr(bytes.size() - end_size);
    if (!end.starts_with(last)) return "its end is missing, or something stands behind it: was it copied whole?";
    const auto byte = [&](std::size_t at) { return static_cast<std::size_t>(static_cast<unsigned char>(end[at])); };
    if (byte(10) + 256 * byte(11) > files_max + 1) return "it has more than " + std::to_string(files_max) + " files";
    return {};
}

// A file that is no regular one, is compressed or hidden in any way.
std::string fault_of_kind(zip_t* archive, zip_uint64_t index, const zip_stat_t& about)
{
    zip_uint8_t system = 0;
    zip_uint32_t attributes = 0;
    zip_file_get_external_attributes(archive, index, 0, &system, &attributes);
    const zip_uint32_t kind = (attributes >> 16) & S_IFMT;
    if (system != ZIP_OPSYS_UNIX || kind != S_IFREG) return "is a link, a folder or no regular file";
    if (about.comp_method != ZIP_CM_STORE) return "is compressed: haptel pack compresses nothing";
    if (about.encryption_method != ZIP_EM_NONE) return "is encrypted";
    if (about.size != about.comp_size) return "has two sizes";
    if (about.size > file_bytes_max) return "has more than " + input::size_in_words(file_bytes_max);
    return {};
}

// Why there are no contents; or all of them.
std::string read_entries(zip_t* archive, Contents& contents)
{
    const zip_int64_t count = zip_get_num_entries(archive, 0);
    std::size_t bytes = 0;
    for (zip_uint64_t i = 0; i < static_cast<zip_uint64_t>(count); ++i) {
        zip_stat_t about;
        if (zip_stat_index(archive, i, ZIP_FL_ENC_RAW, &about) != 0) return "one of its files cannot be read";
        const std::string path = about.name;
        if (std::string fault = fault_of_path(path); !fault.empty()) return fault;
        if (const std::string fault = fault_of_kind(archive, i, about); !fault.empty())
            return "'" + path + "' " + fault;
        if (contents.contains(path)) return "'" + path + "' is there twice";
        bytes += about.size;
        if (bytes > library_bytes_max + sums_bytes_max)
            return "its files have more than " + input::size_in_words(library_bytes_max);
        const std::unique_ptr<zip_file_t, CloseEntry> entry(zip_fopen_index(archive, i, 0));
        std::string text(about.size, '\0');
        char behind = 0; // who reads to the end learns whether the checksum is right
        const bool is_whole =
            entry && zip_fread(entry.get(), text.data(), text.size()) == static_cast<zip_int64_t>(text.size()) &&
            zip_fread(entry.get(), &behind, 1) == 0;
        if (!is_whole) return "'" + path + "' is damaged";
        contents[path] = std::move(text);
    }
    return {};
}

} // namespace

ArchiveResult write_archive(const Package& package)
{
    ZipError error;
    const Source buffer(zip_source_buffer_create(nullptr, 0, 0, &error));
    if (!buffer) return {{}, error.text()};
    zip_source_keep(buffer.get()); // one for the archive, one to read from
    Zip archive(zip_open_from_source(buffer.get(), ZIP_CREATE | ZIP_TRUNCATE, &error));
    if (!archive) {
        zip_source_free(buffer.get());
        return {{}, error.text()};
    }
    for (const auto& [path, bytes] : package.contents)
        if (const std::string fault = add(archive.get(), path, bytes); !fault.empty()) return {{}, fault};
    if (zip_close(archive.get()) != 0) return {{}, zip_error_strerror(zip_get_error(archive.get()))};
    archive.release();
    std::string bytes = bytes_of(buffer.get());
    return bytes.empty() ? ArchiveResult{{}, "the archive could not be made"} : ArchiveResult{std::move(bytes), {}};
}

PackageResult read_archive(std::string_view bytes, const std::string& name)
{
    const auto refused = [&](const std::string& why) {
        return PackageResult{std::nullopt, name + ": error: " + why + "\n"};
    };
    if (const std::string fault = fault_of_ends(bytes); !fault.empty()) return refused(fault);
    ZipError error;
    Source source(zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error));
    const Zip archive(source ? zip_open_from_source(source.get(), ZIP_RDONLY | ZIP_CHECKCONS, &error) : nullptr);
    if (!archive) return refused("it is damaged: " + error.text());
    source.release(); // the archive's
    Contents contents;
    if (const std::string fault = read_entries(archive.get(), contents); !fault.empty()) return refused(fault);
    if (const std::string fault = fault_of_sums(contents); !fault.empty()) return refused(fault);
    return make_package(std::move(contents), name);
}

PackageResult read_archive_file(const std::filesystem::path& file)
{
    const input::FileBytes read = input::read_regular_file(file, archive_bytes_max);
    const std::string name = file.string();
    if (read.refused.refusal != input::Refusal::none)
        return {std::nullopt, name + ": error: it " + read.refused.why + "\n"};
    return read_archive(read.bytes, name);
}

} // namespace haptel::libraries
