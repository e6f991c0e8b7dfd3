//! Predictions for the rooms, and accepting them.

use super::Session;
use crate::app::session::messages::Severity;
use crate::base::wording::count;
use crate::classify::Distribution;
use crate::classify::models::Models;
use crate::edit;
use crate::labels::Label;
use crate::plan::LabelOrigin;
use crate::plan::RoomId;
use crate::plan::RoomLabel;
use crate::predict::Predictions;
use crate::store;
use std::sync::Arc;
impl Session {
    /// The predictions for the current plan; `None` while they are being computed.
    pub fn predictions(&self) -> Option<&Predictions> {
        self.document.as_ref()?.labelled()?.predictions.as_deref()
    }

    /// The second opinion on the current plan, if one is asked for; `None` while it is being computed.
    pub(crate) fn second_opinion(&self) -> Option<&Predictions> {
        self.document.as_ref()?.labelled()?.second.as_deref()
    }

    /// The rooms without a label whose prediction has one of these labels and is so sure, with the label.
    pub(crate) fn acceptable(&self, label: Option<Label>, least: f64) -> Vec<(RoomId, Label)> {
        let Some(predictions) = self.predictions() else { return Vec::new() };
        let rooms = predictions.network.rooms.iter().zip(&predictions.result.distributions);
        let unlabelled = rooms.filter(|(room, _)| room.label.is_none());
        let is_meant = |said: &Distribution| {
            let (likeliest, sure) = said.likeliest();
            label.is_none_or(|label| likeliest == label) && sure >= least
        };
        unlabelled.filter(|(_, said)| is_meant(said)).map(|(room, said)| (room.id, said.label())).collect()
    }

    /// Labels the rooms without a label as predicted, where the prediction has this label and is so sure; in one step.
    pub(crate) fn accept_those(&mut self, label: Option<Label>, least: f64) {
        let said = self.acceptable(label, least);
        let what = match label {
            Some(label) => format!("Accept {label}"),
            None if least > 0.0 => format!("Accept what is {:.0} % sure", 100.0 * least),
            None => "Accept".to_owned(),
        };
        let title = format!("{what}: {}", count(said.len(), "prediction"));
        self.accept(&title, &said);
        self.status = title;
    }

    /// The selected rooms that have a prediction, with the predicted label.
    pub(crate) fn predictions_of_selected(&self) -> Vec<(RoomId, Label)> {
        let Some(predictions) = self.predictions() else { return Vec::new() };
        self.selection.rooms().filter_map(|id| Some((id, predictions.label(id)?))).collect()
    }

    /// Labels the selected rooms as predicted, in one step.
    pub(crate) fn accept_prediction(&mut self) {
        let said = self.predictions_of_selected();
        match said.as_slice() {
            [] => {}
            [(_, label)] => self.accept(&format!("Accept {label}"), &said),
            several => self.accept(&format!("Accept {} predictions", several.len()), &said),
        }
    }

    pub(crate) fn accept(&mut self, title: &str, said: &[(RoomId, Label)]) {
        self.edit(title, |plan| {
            said.iter().try_fold(plan.clone(), |plan, &(id, label)| {
                let given = RoomLabel { label, origin: LabelOrigin::AcceptedPrediction };
                edit::set_label(&plan, id, Some(given))
            })
        });
    }

    /// Labels all rooms without a label as predicted.
    pub(crate) fn accept_all_predictions(&mut self) {
        let said = self.acceptable(None, 0.0);
        let title = format!("Accept {} predictions", said.len());
        self.accept(&title, &said);
        self.status = title;
    }

    /// Loads the user's own label schemes and models from their folders; reports those that cannot be
    /// used.
    pub(crate) fn use_own_schemes_and_models(&mut self) {
        if let Some(folder) = store::schemes_folder() {
            let (schemes, errors) = store::schemes_in(&folder);
            self.schemes = Arc::new(schemes);
            for error in errors {
                self.say_of_program(Severity::Warning, "A label scheme cannot be used", error.to_string());
            }
        }
        if let Some(folder) = store::models_folder() {
            let (own, errors) = store::models_in(&folder);
            self.models = Models::bundled().with(own).with_defaults(store::default_models(&folder));
            for error in errors {
                self.say_of_program(Severity::Warning, "A model cannot be used", error.to_string());
            }
        }
    }
}
