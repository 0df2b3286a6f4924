//! What is thrown: an `Error` of JavaScript with the code of the runtime's error.

use core::fmt::Display;

use js_sys::{Error, Reflect};
use sinew::replay::{RecordError, ReplayError, SinkFull};
use sinew::{AssetError, LengthError, StateError, StepError, TunableError};
use wasm_bindgen::JsValue;

/// An `Error` with a `code`, on its way to JavaScript.
#[derive(Debug)]
pub struct Thrown(Error);

impl Thrown {
    /// An error with the stable name `code`.
    pub(crate) fn new(code: &str, message: &dyn Display) -> Self {
        let error = Error::new(&message.to_string());
        // A new error is an object that takes properties: this cannot fail.
        drop(Reflect::set(&error, &"code".into(), &code.into()));
        Self(error)
    }

    /// That there is no memory for `what`.
    pub(crate) fn out_of_memory(what: &str) -> Self {
        Self::new("OUT_OF_MEMORY", &format_args!("out of memory: {what} are needed"))
    }
}

impl From<Thrown> for JsValue {
    fn from(thrown: Thrown) -> Self {
        thrown.0.into()
    }
}

macro_rules! coded {
    ($($error:ty),*) => {$(
        impl From<$error> for Thrown {
            fn from(error: $error) -> Self {
                Self::new(error.code(), &error)
            }
        }
    )*};
}

coded!(AssetError, LengthError, RecordError, ReplayError, SinkFull, StateError, StepError, TunableError);
