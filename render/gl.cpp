#include "render/gl.h"

#include <cstring>
#include <stdexcept>

namespace palpa::render {
namespace {

GLuint compile(GLenum kind, const char* source) {
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good) return shader;
    char log[1024] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    throw std::runtime_error(std::string("this graphics driver does not take a shader: ") + log);
}

}  // namespace

Program::Program(const char* vertex_source, const char* fragment_source) {
    const GLuint vertex = compile(GL_VERTEX_SHADER, vertex_source);
    const GLuint fragment = compile(GL_FRAGMENT_SHADER, fragment_source);
    id_ = glCreateProgram();
    glAttachShader(id_, vertex);
    glAttachShader(id_, fragment);
    glLinkProgram(id_);
    glDeleteShader(vertex);
    glDeleteShader(fragment);
    GLint good = 0;
    glGetProgramiv(id_, GL_LINK_STATUS, &good);
    if (good) return;
    char log[1024] = "";
    glGetProgramInfoLog(id_, sizeof log, nullptr, log);
    throw std::runtime_error(std::string("this graphics driver does not link a shader: ") + log);
}

Program::~Program() { glDeleteProgram(id_); }

Mesh::Mesh(const std::vector<float>& points, const std::vector<unsigned>& triangles)
    : count_(static_cast<GLsizei>(triangles.size())) {
    glGenVertexArrays(1, &vertex_array_);
    glBindVertexArray(vertex_array_);
    glGenBuffers(3, buffers_);
    glBindBuffer(GL_ARRAY_BUFFER, buffers_[0]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(points.size() * sizeof(float)), points.data(),
                 GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers_[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(triangles.size() * sizeof(unsigned)),
                 triangles.data(), GL_STATIC_DRAW);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glBindVertexArray(0);
}

Mesh::~Mesh() {
    glDeleteBuffers(3, buffers_);
    glDeleteVertexArrays(1, &vertex_array_);
}

void Mesh::set_second(const std::vector<float>& values) {
    glBindVertexArray(vertex_array_);
    glBindBuffer(GL_ARRAY_BUFFER, buffers_[2]);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(values.size() * sizeof(float)), values.data(),
                 GL_STREAM_DRAW);
    glEnableVertexAttribArray(1);
    glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
    glBindVertexArray(0);
}

void Mesh::draw() const {
    glBindVertexArray(vertex_array_);
    glDrawElements(GL_TRIANGLES, count_, GL_UNSIGNED_INT, nullptr);
    glBindVertexArray(0);
}

AreaCopy::AreaCopy() {
    glGenTextures(1, &texture_);
    glGenFramebuffers(1, &framebuffer_);
}

AreaCopy::~AreaCopy() {
    glDeleteFramebuffers(1, &framebuffer_);
    glDeleteTextures(1, &texture_);
}

bool AreaCopy::take(int width_px, int height_px) {
    width_px_ = width_px;
    height_px_ = height_px;
    glBindTexture(GL_TEXTURE_2D, texture_);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGB, 0, 0, width_px, height_px, 0);
    glBindTexture(GL_TEXTURE_2D, 0);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
    const bool good = glCheckFramebufferStatus(GL_READ_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    return good && glGetError() == GL_NO_ERROR;
}

void AreaCopy::put() const {
    // a browser clears what it has shown at the next call that draws, for which Chromium does not take a blit
    clear_screen(width_px_, height_px_);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
    glBlitFramebuffer(0, 0, width_px_, height_px_, 0, 0, width_px_, height_px_, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
}

Texture::Texture(int side_px) : side_px_(side_px) {
    glGenTextures(1, &texture_);
    glGenFramebuffers(1, &framebuffer_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, side_px, side_px, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glBindTexture(GL_TEXTURE_2D, 0);
}

Texture::~Texture() {
    glDeleteFramebuffers(1, &framebuffer_);
    glDeleteTextures(1, &texture_);
}

bool Texture::begin() {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
    glViewport(0, 0, side_px_, side_px_);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return true;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return false;
}

void Texture::end() {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glGenerateMipmap(GL_TEXTURE_2D);
    glBindTexture(GL_TEXTURE_2D, 0);
}

void Texture::bind(bool much_smaller) const {
    glBindTexture(GL_TEXTURE_2D, texture_);
    // choosing among sizes costs software drawing as much as the rest of a look-up
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, much_smaller ? GL_LINEAR_MIPMAP_NEAREST : GL_LINEAR);
}

Layer::Layer() {
    glGenFramebuffers(1, &framebuffer_);
    glGenRenderbuffers(2, buffers_);
}

Layer::~Layer() {
    glDeleteRenderbuffers(2, buffers_);
    glDeleteFramebuffers(1, &framebuffer_);
}

bool Layer::begin(int width_px, int height_px) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    if (width_px != width_px_ || height_px != height_px_) {
        constexpr GLenum kFormats[2] = {GL_RGBA8, GL_DEPTH_COMPONENT24};
        constexpr GLenum kPlaces[2] = {GL_COLOR_ATTACHMENT0, GL_DEPTH_ATTACHMENT};
        for (int i = 0; i < 2; ++i) {
            glBindRenderbuffer(GL_RENDERBUFFER, buffers_[i]);
            glRenderbufferStorage(GL_RENDERBUFFER, kFormats[i], width_px, height_px);
            glFramebufferRenderbuffer(GL_FRAMEBUFFER, kPlaces[i], GL_RENDERBUFFER, buffers_[i]);
        }
        glBindRenderbuffer(GL_RENDERBUFFER, 0);
        width_px_ = width_px;
        height_px_ = height_px;
    }
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE) return true;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return false;
}

void Layer::show(int width_px, int height_px) {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    clear_screen(width_px, height_px);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
    glBlitFramebuffer(0, 0, width_px_, height_px_, 0, 0, width_px, height_px, GL_COLOR_BUFFER_BIT, GL_LINEAR);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
}

bool draws_in_software() {
    const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    if (renderer == nullptr) return false;
    for (const char* name : {"llvmpipe", "softpipe", "swrast", "SwiftShader"}) {
        if (std::strstr(renderer, name) != nullptr) return true;
    }
    return false;
}

void clear_screen(int width_px, int height_px) {
    glViewport(0, 0, width_px, height_px);
    glClearColor(0.11f, 0.12f, 0.13f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

std::vector<unsigned char> read_pixels(int width_px, int height_px) {
    const auto width = static_cast<std::size_t>(width_px);
    const auto height = static_cast<std::size_t>(height_px);
    std::vector<unsigned char> rgba(4 * width * height);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width_px, height_px, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    std::vector<unsigned char> rgb(3 * width * height);
    for (std::size_t y = 0; y < height; ++y) {
        const unsigned char* from = rgba.data() + 4 * (height - 1 - y) * width;
        unsigned char* to = rgb.data() + 3 * y * width;
        for (std::size_t x = 0; x < width; ++x, from += 4, to += 3) {
            to[0] = from[0];
            to[1] = from[1];
            to[2] = from[2];
        }
    }
    return rgb;
}

}  // namespace palpa::render
