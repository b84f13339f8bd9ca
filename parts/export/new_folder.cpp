#include "parts/export/new_folder.h"

#include <stdexcept>

#include "files/input_error.h"

namespace palpa::parts {

NewFolder::NewFolder(const std::filesystem::path& folder)
    : folder_(folder.has_filename() ? folder : folder.parent_path()), partial_(folder_.string() + ".partial") {
    std::error_code error;
    if (std::filesystem::exists(folder_) &&
        !(std::filesystem::is_directory(folder_) && std::filesystem::is_empty(folder_))) {
        throw files::bad_input(folder_.string(), "", "a file, or a folder with files in it",
                               "a new or an empty folder");
    }
    std::filesystem::remove_all(partial_, error);
    std::filesystem::create_directories(partial_, error);
    if (error) throw std::runtime_error(partial_.string() + ": cannot be made: " + error.message());
}

NewFolder::~NewFolder() {
    std::error_code ignored;
    if (!kept_) std::filesystem::remove_all(partial_, ignored);
}

void NewFolder::keep() {
    std::error_code error;
    std::filesystem::remove(folder_, error);
    std::filesystem::rename(partial_, folder_, error);
    if (error) throw std::runtime_error(folder_.string() + ": cannot be made: " + error.message());
    kept_ = true;
}

}  // namespace palpa::parts
