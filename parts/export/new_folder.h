#pragma once
// A folder that is there with all its files, or not at all.

#include <filesystem>

namespace palpa::parts {

class NewFolder {
  public:
    // Makes FOLDER.partial. Throws InputError if the folder is there and not empty, std::runtime_error if it cannot be made.
    explicit NewFolder(const std::filesystem::path& folder);
    ~NewFolder();  // takes away what was not kept
    NewFolder(const NewFolder&) = delete;
    NewFolder& operator=(const NewFolder&) = delete;
    const std::filesystem::path& path() const { return partial_; }
    void keep();  // gives the folder its name

  private:
    std::filesystem::path folder_, partial_;
    bool kept_ = false;
};

}  // namespace palpa::parts
