// Measures GPU time with a ring of timestamp queries.

#include "gpu/gpu_timer.h"

#include <epoxy/gl.h>

namespace viewer {

GpuTimer::GpuTimer() {
    glCreateQueries(GL_TIMESTAMP, static_cast<GLsizei>(queries_.size()), queries_.data());
}

GpuTimer::~GpuTimer() {
    glDeleteQueries(static_cast<GLsizei>(queries_.size()), queries_.data());
}

void GpuTimer::begin() {
    while (read_ < started_) {
        const std::size_t slot = 2 * (read_ % kRounds);
        GLint there = GL_FALSE;
        glGetQueryObjectiv(queries_[slot + 1], GL_QUERY_RESULT_AVAILABLE, &there);
        if (!there)
            break;
        GLuint64 from = 0, to = 0;
        glGetQueryObjectui64v(queries_[slot], GL_QUERY_RESULT, &from);
        glGetQueryObjectui64v(queries_[slot + 1], GL_QUERY_RESULT, &to);
        milliseconds_ = static_cast<double>(to - from) * 1e-6;
        ++read_;
    }
    measuring_ = started_ - read_ < kRounds; // skip the measurement if all queries are in flight
    if (measuring_)
        glQueryCounter(queries_[2 * (started_ % kRounds)], GL_TIMESTAMP);
}

void GpuTimer::end() {
    if (!measuring_)
        return;
    glQueryCounter(queries_[2 * (started_ % kRounds) + 1], GL_TIMESTAMP);
    ++started_;
}

} // namespace viewer
