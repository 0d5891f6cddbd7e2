// Open CASCADE keeps settings for the whole process; a session borrows them and gives them back.
#pragma once

#include <mutex>

#include <Message_SequenceOfPrinters.hxx>
#include <Standard_Handle.hxx>
#include <XSAlgo_AlgoContainer.hxx>

namespace insym {

/// Whether shapes are as the file has them or as Open CASCADE repairs them for other programs too: with the
/// seams and the curves in parameters that files leave out, without which faces have no area.
enum class Healing { off, on };

/// While it lives, Open CASCADE prints nothing, and heals shapes or not. Sessions wait for one another.
class OcctSession {
public:
    explicit OcctSession(Healing healing);
    ~OcctSession();
    OcctSession(const OcctSession&) = delete;
    OcctSession& operator=(const OcctSession&) = delete;

private:
    std::lock_guard<std::mutex> lock_;
    Message_SequenceOfPrinters printers_;
    Handle(XSAlgo_AlgoContainer) algorithms_;
};

}  // namespace insym
