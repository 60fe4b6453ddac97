//! Rubber (2.2.3, 3.2.1): an eight-chain network in parallel with Maxwell elements.
//!
//! The network ([`eight_chain`]) is hyperelastic and compressible; each Maxwell element ([`maxwell`]) is driven by the
//! deviatoric stress of the network and relaxes. Every function takes the Green–Lagrange strain and keeps full
//! precision at small strain.
pub mod eight_chain;
pub mod five_terms;
pub mod langevin;
pub mod maxwell;
pub mod named;

use eight_chain::EightChain;
use maxwell::Maxwell;
use thiserror::Error;

/// Constants of a rubber.
#[derive(Clone, Debug, PartialEq)]
pub struct Elastomer {
    pub network: EightChain,
    /// Any number, including none; equal relaxation times are allowed.
    pub maxwell: Vec<Maxwell>,
}

#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum ElastomerError {
    #[error("the rubber modulus is {0} Pa; it must be positive and finite")]
    Modulus(f64),
    #[error("the network locking number is {0}; it must be positive and finite")]
    Locking(f64),
    #[error(
        "the network locking number is {0}; with the exact inverse Langevin function it must be above 1: at 1 the \
         chains are straight in the undeformed rubber"
    )]
    LockedAtRest(f64),
    #[error("the bulk modulus is {0} Pa; it must be positive and finite")]
    Bulk(f64),
    #[error("the constant of a Maxwell element is {0}; it must be positive and finite")]
    Gamma(f64),
    #[error("the relaxation time of a Maxwell element is {0} s; it must be positive and finite")]
    Tau(f64),
    #[error("the step is {0} s; it must not be negative")]
    Step(f64),
    #[error(
        "the chain stretch is {stretch:.4}; it must be below the locking stretch {limit:.4}: reduce the load"
    )]
    Locked { stretch: f64, limit: f64 },
    #[error(
        "the determinant of the right Cauchy-Green tensor is {0:.3e}; it must be positive: \
         no deformation has this strain"
    )]
    NoDeformation(f64),
}

impl Elastomer {
    /// Checks the constants.
    ///
    /// # Errors
    /// Those of [`EightChain::new`] and [`Maxwell::new`].
    pub fn check(&self) -> Result<(), ElastomerError> {
        let EightChain { modulus, locking, bulk, pull } = self.network;
        EightChain::new(modulus, locking, bulk, pull)?;
        self.maxwell.iter().try_for_each(|m| Maxwell::new(m.gamma, m.tau).map(|_| ()))
    }

    /// Shear modulus μ (Pa) for strain rates faster than every Maxwell element; it sizes explicit steps.
    pub fn instantaneous_shear_modulus(&self) -> f64 {
        let sum: f64 = self.maxwell.iter().map(|element| element.gamma).sum();
        (1.0 + sum) * self.network.shear_modulus()
    }
}
