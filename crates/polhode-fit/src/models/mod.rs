//! The torque models, and errors of the record in the place of a torque, beside each other: what each makes of the tensor, how likely it is,
//! and how far the answer rests on the choice.

pub(crate) mod equations;
pub(crate) mod reading_error;
pub(crate) mod weighed;

use crate::settings::torque::TorqueModel;

/// Every model of the torque, each after those that it adds to.
pub(crate) const MODELS: [TorqueModel; 5] =
    [TorqueModel::None, TorqueModel::Drag, TorqueModel::Quadratic, TorqueModel::Drag3, TorqueModel::Constant];
