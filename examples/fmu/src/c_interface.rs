//! The C functions of FMI 3.0 for co-simulation. What the FMU has no variables or capabilities for returns an error, as
//! the standard asks.

use crate::model::{Model, ModelError, State};
use crate::variables::{INPUTS, OUTPUTS};
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;

/// `fmi3Status`.
pub type Status = c_int;
const OK: Status = 0;
const ERROR: Status = 3;

/// `fmi3LogMessageCallback`: environment, status, category, message.
pub type Log = Option<unsafe extern "C" fn(*mut c_void, Status, *const c_char, *const c_char)>;

pub struct Instance {
    model: Model,
    log: Log,
    environment: *mut c_void,
}

fn tell(log: Log, environment: *mut c_void, message: &str) {
    let (Some(log), Ok(message)) = (log, CString::new(message)) else { return };
    unsafe { log(environment, ERROR, c"logStatusError".as_ptr(), message.as_ptr()) };
}

/// Runs a function on the instance; errors and panics are logged and become a status.
unsafe fn with(
    instance: *mut Instance,
    run: impl FnOnce(&mut Model) -> Result<(), ModelError>,
) -> Status {
    let Some(of) = (unsafe { instance.as_mut() }) else { return ERROR };
    let Instance { model, log, environment } = of;
    match catch_unwind(AssertUnwindSafe(|| run(model))) {
        Ok(Ok(())) => OK,
        Ok(Err(error)) => {
            tell(*log, *environment, &error.to_string());
            ERROR
        }
        Err(_) => {
            tell(*log, *environment, "internal error: please report the scene");
            ERROR
        }
    }
}

/// A slice of C; an empty one may be null.
unsafe fn slice<'a, T>(first: *const T, len: usize) -> &'a [T] {
    if len == 0 { &[] } else { unsafe { std::slice::from_raw_parts(first, len) } }
}

unsafe fn slice_mut<'a, T>(first: *mut T, len: usize) -> &'a mut [T] {
    if len == 0 { &mut [] } else { unsafe { std::slice::from_raw_parts_mut(first, len) } }
}

/// Path of the scene in the resources: a path or a file URI.
unsafe fn scene_path(resources: *const c_char) -> Option<PathBuf> {
    if resources.is_null() {
        return None;
    }
    let text = unsafe { CStr::from_ptr(resources) }.to_str().ok()?;
    let folder = PathBuf::from(text.strip_prefix("file://").unwrap_or(text));
    let scenes = ["scene.toml", "scene.json"].map(|name| folder.join(name));
    scenes.into_iter().find(|path| path.is_file())
}

#[unsafe(no_mangle)]
pub extern "C" fn fmi3GetVersion() -> *const c_char {
    c"3.0".as_ptr()
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3InstantiateCoSimulation(
    _name: *const c_char,
    _token: *const c_char,
    resources: *const c_char,
    _visible: bool,
    _logging: bool,
    _event_mode: bool,
    _early_return: bool,
    _intermediate: *const u32,
    _intermediate_count: usize,
    environment: *mut c_void,
    log: Log,
    _intermediate_update: *const c_void,
) -> *mut Instance {
    let Some(path) = (unsafe { scene_path(resources) }) else {
        tell(log, environment, "the resources of the FMU have no scene.toml");
        return std::ptr::null_mut();
    };
    match catch_unwind(|| Model::read(&path)) {
        Ok(Ok(model)) => Box::into_raw(Box::new(Instance { model, log, environment })),
        Ok(Err(error)) => {
            tell(log, environment, &error.to_string());
            std::ptr::null_mut()
        }
        Err(_) => std::ptr::null_mut(),
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeInstance(instance: *mut Instance) {
    if !instance.is_null() {
        drop(unsafe { Box::from_raw(instance) });
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3EnterInitializationMode(
    instance: *mut Instance,
    _has_tolerance: bool,
    _tolerance: f64,
    start: f64,
    _has_stop: bool,
    _stop: f64,
) -> Status {
    let begin = |model: &mut Model| {
        model.begin(start);
        Ok(())
    };
    unsafe { with(instance, begin) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3ExitInitializationMode(instance: *mut Instance) -> Status {
    unsafe { with(instance, Model::end_initialization) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Terminate(instance: *mut Instance) -> Status {
    unsafe { with(instance, |_| Ok(())) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetDebugLogging(
    instance: *mut Instance,
    _on: bool,
    _count: usize,
    _categories: *const *const c_char,
) -> Status {
    unsafe { with(instance, |_| Ok(())) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3Reset(instance: *mut Instance) -> Status {
    let reset = |model: &mut Model| {
        model.reset();
        Ok(())
    };
    unsafe { with(instance, reset) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFloat64(
    instance: *mut Instance,
    references: *const u32,
    count: usize,
    values: *mut f64,
    value_count: usize,
) -> Status {
    let get = |model: &mut Model| {
        let (references, values) =
            unsafe { (slice(references, count), slice_mut(values, value_count)) };
        for (reference, value) in references.iter().zip(values) {
            *value = match *reference as usize {
                0 => model.time(),
                input @ 1..=INPUTS => model.inputs[input - 1],
                output if output <= INPUTS + OUTPUTS => model.outputs()?[output - INPUTS - 1],
                _ => return Err(ModelError::Reference(*reference)),
            };
        }
        Ok(())
    };
    unsafe { with(instance, get) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFloat64(
    instance: *mut Instance,
    references: *const u32,
    count: usize,
    values: *const f64,
    value_count: usize,
) -> Status {
    let set = |model: &mut Model| {
        let (references, values) =
            unsafe { (slice(references, count), slice(values, value_count)) };
        for (reference, value) in references.iter().zip(values) {
            match *reference as usize {
                input @ 1..=INPUTS => model.set_input(input - 1, *value)?,
                _ => return Err(ModelError::Reference(*reference)),
            }
        }
        Ok(())
    };
    unsafe { with(instance, set) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DoStep(
    instance: *mut Instance,
    from: f64,
    step: f64,
    _no_earlier_state: bool,
    event_needed: *mut bool,
    terminate: *mut bool,
    early_return: *mut bool,
    last_time: *mut f64,
) -> Status {
    let run = |model: &mut Model| {
        let outcome = model.step(from, step);
        let time = model.time();
        for flag in [event_needed, terminate, early_return] {
            if let Some(flag) = unsafe { flag.as_mut() } {
                *flag = false;
            }
        }
        if let Some(last) = unsafe { last_time.as_mut() } {
            *last = time;
        }
        outcome
    };
    unsafe { with(instance, run) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFMUState(
    instance: *mut Instance,
    state: *mut *mut State,
) -> Status {
    let get = |model: &mut Model| {
        // A state given back is overwritten.
        match unsafe { (*state).as_mut() } {
            Some(old) => *old = model.state(),
            None => unsafe { *state = Box::into_raw(Box::new(model.state())) },
        }
        Ok(())
    };
    unsafe { with(instance, get) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFMUState(instance: *mut Instance, state: *const State) -> Status {
    let set = |model: &mut Model| match unsafe { state.as_ref() } {
        Some(state) => model.set_state(state),
        None => Err(ModelError::OtherState),
    };
    unsafe { with(instance, set) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeFMUState(
    instance: *mut Instance,
    state: *mut *mut State,
) -> Status {
    let free = |_: &mut Model| {
        let freed = unsafe { std::mem::replace(&mut *state, std::ptr::null_mut()) };
        if !freed.is_null() {
            drop(unsafe { Box::from_raw(freed) });
        }
        Ok(())
    };
    unsafe { with(instance, free) }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializedFMUStateSize(
    instance: *mut Instance,
    state: *const State,
    size: *mut usize,
) -> Status {
    unsafe {
        with(instance, |_| {
            let state = state.as_ref().ok_or(ModelError::OtherState)?;
            *size = state.to_bytes().len();
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializeFMUState(
    instance: *mut Instance,
    state: *const State,
    bytes: *mut u8,
    size: usize,
) -> Status {
    unsafe {
        with(instance, |_| {
            let text = state.as_ref().ok_or(ModelError::OtherState)?.to_bytes();
            let room = slice_mut(bytes, size).get_mut(..text.len());
            room.ok_or(ModelError::OtherState)?.copy_from_slice(&text);
            Ok(())
        })
    }
}

#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DeserializeFMUState(
    instance: *mut Instance,
    bytes: *const u8,
    size: usize,
    state: *mut *mut State,
) -> Status {
    unsafe {
        with(instance, |_| {
            let read = State::from_bytes(slice(bytes, size)).ok_or(ModelError::OtherState)?;
            *state = Box::into_raw(Box::new(read));
            Ok(())
        })
    }
}

/// Arguments are left to the caller, as in C.
macro_rules! not_offered {
    ($($name:ident)*) => { $(
        #[unsafe(no_mangle)]
        pub extern "C" fn $name() -> Status {
            ERROR
        }
    )* };
}

not_offered! {
    fmi3EnterEventMode fmi3EnterStepMode fmi3EnterConfigurationMode fmi3ExitConfigurationMode
    fmi3GetFloat32 fmi3GetInt8 fmi3GetUInt8 fmi3GetInt16 fmi3GetUInt16 fmi3GetInt32 fmi3GetUInt32 fmi3GetInt64
    fmi3GetUInt64 fmi3GetBoolean fmi3GetString fmi3GetBinary fmi3GetClock
    fmi3SetFloat32 fmi3SetInt8 fmi3SetUInt8 fmi3SetInt16 fmi3SetUInt16 fmi3SetInt32 fmi3SetUInt32 fmi3SetInt64
    fmi3SetUInt64 fmi3SetBoolean fmi3SetString fmi3SetBinary fmi3SetClock
    fmi3GetNumberOfVariableDependencies fmi3GetVariableDependencies
    fmi3GetDirectionalDerivative fmi3GetAdjointDerivative fmi3GetOutputDerivatives
    fmi3GetIntervalDecimal fmi3GetIntervalFraction fmi3GetShiftDecimal fmi3GetShiftFraction
    fmi3SetIntervalDecimal fmi3SetIntervalFraction fmi3SetShiftDecimal fmi3SetShiftFraction
    fmi3EvaluateDiscreteStates fmi3UpdateDiscreteStates fmi3EnterContinuousTimeMode fmi3CompletedIntegratorStep
    fmi3SetTime fmi3SetContinuousStates fmi3GetContinuousStates fmi3GetContinuousStateDerivatives
    fmi3GetEventIndicators fmi3GetNominalsOfContinuousStates fmi3GetNumberOfEventIndicators
    fmi3GetNumberOfContinuousStates fmi3ActivateModelPartition
}

/// No instance of other interfaces.
macro_rules! no_instance {
    ($($name:ident)*) => { $(
        #[unsafe(no_mangle)]
        pub extern "C" fn $name() -> *mut c_void {
            std::ptr::null_mut()
        }
    )* };
}

no_instance! { fmi3InstantiateModelExchange fmi3InstantiateScheduledExecution }
