#include "brep/occt_session.hpp"

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_Printer.hxx>
#include <Message_ProgressRange.hxx>
#include <STEPControl_Controller.hxx>
#include <TopoDS_Shape.hxx>
#include <XSAlgo.hxx>

namespace insym {
namespace {

std::mutex& session_mutex() {
    static std::mutex mutex;
    return mutex;
}

/// The algorithms of a data exchange, less the healing of shapes.
class UnhealedShapes : public XSAlgo_AlgoContainer {
public:
    TopoDS_Shape ProcessShape(const TopoDS_Shape& shape, Standard_Real /*precision*/,
                              Standard_Real /*max_tolerance*/, Standard_CString /*resource*/,
                              Standard_CString /*sequence*/, Handle(Standard_Transient) & /*info*/,
                              const Message_ProgressRange& /*progress*/,
                              Standard_Boolean /*non_manifold*/) const override {
        return shape;
    }
};

}  // namespace

OcctSession::OcctSession(Healing healing)
    : lock_(session_mutex()), printers_(Message::DefaultMessenger()->Printers()) {
    STEPControl_Controller::Init();  // makes the settings, if nothing was read before
    algorithms_ = XSAlgo::AlgoContainer();
    if (healing == Healing::off) XSAlgo::SetAlgoContainer(new UnhealedShapes);
    Message::DefaultMessenger()->ChangePrinters().Clear();
}

OcctSession::~OcctSession() {
    Message::DefaultMessenger()->ChangePrinters() = printers_;
    XSAlgo::SetAlgoContainer(algorithms_);
}

}  // namespace insym
