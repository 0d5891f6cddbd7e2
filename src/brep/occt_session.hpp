// Open CASCADE keeps settings for the whole process; a session borrows them and gives them back.
#pragma once

#include <mutex>

#include <Message_SequenceOfPrinters.hxx>
#include <Standard_Handle.hxx>
#include <XSAlgo_AlgoContainer.hxx>

namespace insym {

/// While it lives, Open CASCADE prints nothing and gives shapes as the file has them.
///
/// Sessions wait for one another. Shapes are not healed: healing splits edges and adds vertices where the
/// seams of surfaces happen to lie, which no designer put there, and takes ten times as long as the rest.
class OcctSession {
public:
    OcctSession();
    ~OcctSession();
    OcctSession(const OcctSession&) = delete;
    OcctSession& operator=(const OcctSession&) = delete;

private:
    std::lock_guard<std::mutex> lock_;
    Message_SequenceOfPrinters printers_;
    Handle(XSAlgo_AlgoContainer) algorithms_;
};

}  // namespace insym
