//! Several backends that render one picture together.
//!
//! Each pass's range of samples is split among the members by how fast they were so far, they render
//! their parts at the same time, each to a film of its own, and the films are merged. Sums are exact, so
//! the picture does not depend on who rendered what, and nothing but time is lost if the split was bad.

use std::time::Instant;

use crate::{
    Backend, BackendError, BackendErrorKind, BackendInfo, Control, Film, SampleRange, Times,
};

/// How long a pass should take once the members' speeds are known.
const PASS_S: f64 = 2.0;
/// The pass after the first, whose measurements are those of a cold start.
const SECOND_PASS_S: f64 = 0.1;

/// Backends that render together.
pub struct Team {
    members: Vec<Member>,
    /// Passes so far.
    n_passes: u32,
    /// Times of members that failed.
    before: Times,
    failures: Vec<String>,
}

struct Member {
    backend: Box<dyn Backend + Send>,
    film: Option<Film>,
    /// Samples of the whole picture per second, once measured.
    speed: Option<f64>,
}

/// What became of a member's part of a pass.
enum Outcome {
    Done,
    Stopped,
    Failed(BackendError),
}

impl Team {
    /// A team of these.
    ///
    /// # Errors
    /// If there are none.
    pub fn new(backends: Vec<Box<dyn Backend + Send>>) -> Result<Self, BackendError> {
        if backends.is_empty() {
            let message = "a team of backends needs at least one";
            return Err(BackendError::new(BackendErrorKind::InvalidOption, message));
        }
        let member = |backend| Member { backend, film: None, speed: None };
        Ok(Self {
            members: backends.into_iter().map(member).collect(),
            n_passes: 0,
            before: Times::default(),
            failures: Vec::new(),
        })
    }

    /// Number of samples of the coming pass.
    fn pass_size(&self, n_left: u32) -> u32 {
        let speed: f64 = self.members.iter().filter_map(|member| member.speed).sum();
        let n = match self.n_passes {
            0 => self.members.len() as f64,
            1 => speed * SECOND_PASS_S,
            _ => speed * PASS_S,
        };
        // A remainder that would make a very short pass of its own is taken along.
        let n = n.clamp(1.0, f64::from(n_left)) as u32;
        if n_left - n < n / 4 { n_left } else { n }
    }
}

/// `n` shared out in proportion to `speeds`, all of it.
fn shares(n: u32, speeds: &[f64]) -> Vec<u32> {
    let total: f64 = speeds.iter().sum();
    let mut ends = 0.0;
    let mut given = 0;
    let mut shares: Vec<u32> = speeds
        .iter()
        .map(|speed| {
            ends += if total > 0.0 { speed / total } else { 1.0 / speeds.len() as f64 };
            let end = ((ends * f64::from(n)).round() as u32).clamp(given, n);
            let share = end - given;
            given = end;
            share
        })
        .collect();
    if let Some(last) = shares.last_mut() {
        *last += n - given;
    }
    shares
}

impl Member {
    /// Renders its part to its own film.
    fn render(&mut self, region: crate::Region, part: SampleRange, control: &Control) -> Outcome {
        let film = match &mut self.film {
            Some(film) if film.region == region => {
                film.clear();
                film
            }
            film => film.insert(Film::new(region)),
        };
        let start = Instant::now();
        let mut n_done = 0;
        while n_done < part.count {
            let left = SampleRange { first: part.first + n_done, count: part.count - n_done };
            match self.backend.render(film, left, control) {
                Ok(0) => return Outcome::Stopped,
                Ok(n) => n_done += n,
                Err(error) => return Outcome::Failed(error),
            }
        }
        if n_done > 0 {
            self.speed = Some(f64::from(n_done) / start.elapsed().as_secs_f64().max(1e-9));
        }
        Outcome::Done
    }
}

impl Backend for Team {
    fn info(&self) -> BackendInfo {
        let infos: Vec<BackendInfo> = self.members.iter().map(|m| m.backend.info()).collect();
        let all_same = infos.iter().all(|info| info.name == infos[0].name);
        let devices: Vec<&str> = infos.iter().map(|info| info.device.as_str()).collect();
        let name = if all_same { infos[0].name } else { "hybrid" };
        BackendInfo { name, device: devices.join(" + ") }
    }

    fn render(
        &mut self,
        film: &mut Film,
        samples: SampleRange,
        control: &Control,
    ) -> Result<u32, BackendError> {
        let n = self.pass_size(samples.count);
        // Parts that are still to be rendered: the whole at first, then those of members that failed.
        let mut open = vec![SampleRange { first: samples.first, count: n }];
        let region = film.region;
        while let Some(range) = open.pop() {
            let even = self.members.iter().any(|member| member.speed.is_none());
            let speeds: Vec<f64> = self
                .members
                .iter()
                .map(|member| if even { 1.0 } else { member.speed.unwrap_or(1.0) })
                .collect();
            let mut first = range.first;
            let parts: Vec<SampleRange> = shares(range.count, &speeds)
                .into_iter()
                .map(|count| {
                    let part = SampleRange { first, count };
                    first += count;
                    part
                })
                .collect();
            let outcomes: Vec<Outcome> = std::thread::scope(|scope| {
                let threads: Vec<_> = self
                    .members
                    .iter_mut()
                    .zip(&parts)
                    .map(|(member, part)| scope.spawn(|| member.render(region, *part, control)))
                    .collect();
                threads
                    .into_iter()
                    .map(|thread| match thread.join() {
                        Ok(outcome) => outcome,
                        Err(panic) => std::panic::resume_unwind(panic),
                    })
                    .collect()
            });
            if outcomes.iter().any(|outcome| matches!(outcome, Outcome::Stopped)) {
                return Ok(0);
            }
            let mut last_error = None;
            let mut kept = Vec::new();
            for ((member, part), outcome) in self.members.drain(..).zip(parts).zip(outcomes) {
                match outcome {
                    Outcome::Failed(error) => {
                        let device = member.backend.info().device;
                        self.failures.push(format!("{device} failed: {error}"));
                        self.before = self.before.plus(&member.backend.times());
                        open.push(part);
                        last_error = Some(error);
                    }
                    Outcome::Done | Outcome::Stopped => {
                        if let (true, Some(part)) = (part.count > 0, &member.film) {
                            film.merge(part);
                        }
                        kept.push(member);
                    }
                }
            }
            self.members = kept;
            if let (true, Some(error)) = (self.members.is_empty(), last_error) {
                return Err(error);
            }
        }
        self.n_passes += 1;
        Ok(n)
    }

    fn times(&self) -> Times {
        let times = self.members.iter().map(|member| member.backend.times());
        times.fold(self.before, |sum, times| sum.plus(&times))
    }

    fn failures(&self) -> Vec<String> {
        self.failures.clone()
    }
}

#[cfg(test)]
mod tests {
    use zrak_core::film::PixelSum;
    use zrak_core::math::Color;

    use super::*;
    use crate::{Region, Rendered, render};

    /// Adds the sample's index to every pixel, slowly or not, and fails once it has done so many.
    struct Counter {
        name: &'static str,
        pause_ms: u64,
        fails_after: u32,
        n_done: u32,
    }

    impl Backend for Counter {
        fn info(&self) -> BackendInfo {
            BackendInfo { name: self.name, device: format!("{} device", self.name) }
        }

        fn render(
            &mut self,
            film: &mut Film,
            samples: SampleRange,
            control: &Control,
        ) -> Result<u32, BackendError> {
            let count = samples.count.min(7);
            if self.n_done + count > self.fails_after {
                return Err(BackendError::new(BackendErrorKind::Failed, "it is tired"));
            }
            std::thread::sleep(std::time::Duration::from_millis(self.pause_ms));
            for sample in samples.first..samples.first + count {
                for pixel in &mut film.pixels {
                    pixel.add_sample(Color::grey(sample as f32), 1);
                }
            }
            control.count_samples(u64::from(count));
            self.n_done += count;
            Ok(count)
        }

        fn times(&self) -> Times {
            Times { render_s: f64::from(self.n_done), ..Times::default() }
        }
    }

    fn counter(name: &'static str, pause_ms: u64, fails_after: u32) -> Box<dyn Backend + Send> {
        Box::new(Counter { name, pause_ms, fails_after, n_done: 0 })
    }

    fn rendered(team: &mut Team, n: u32) -> Result<Film, String> {
        let start = Rendered { film: Film::new(Region::whole(3, 2)), n_samples: 0 };
        let result = render(team, start, n, &Control::default());
        result.map(|r| r.film).map_err(|e| e.to_string())
    }

    fn expected(n: u32) -> PixelSum {
        let mut sum = PixelSum::ZERO;
        (0..n).for_each(|i| sum.add_sample(Color::grey(i as f32), 1));
        sum
    }

    #[test]
    fn every_sample_is_rendered_once_by_somebody() {
        for n in [1, 2, 3, 100, 1001] {
            let members = vec![counter("a", 0, u32::MAX), counter("b", 1, u32::MAX)];
            let mut team = Team::new(members).unwrap();
            let film = rendered(&mut team, n).unwrap();
            assert!(film.pixels.iter().all(|pixel| *pixel == expected(n)), "{n}");
            assert_eq!(team.times().render_s, f64::from(n));
            assert_eq!(team.info().name, "hybrid");
            assert!(team.failures().is_empty());
        }
    }

    #[test]
    fn who_fails_is_replaced_by_the_others() {
        for fails_after in [0, 1, 8, 50] {
            let members = vec![counter("a", 0, u32::MAX), counter("b", 0, fails_after)];
            let mut team = Team::new(members).unwrap();
            let film = rendered(&mut team, 300).unwrap();
            assert!(film.pixels.iter().all(|pixel| *pixel == expected(300)), "{fails_after}");
            assert_eq!(team.failures(), ["b device failed: it is tired"]);
            assert_eq!(team.info().name, "a");
        }
        let mut team = Team::new(vec![counter("a", 0, 10), counter("b", 0, 20)]).unwrap();
        assert_eq!(rendered(&mut team, 300).unwrap_err(), "it is tired");
        assert!(Team::new(Vec::new()).is_err());
    }

    #[test]
    fn the_fast_get_more() {
        assert_eq!(shares(10, &[1.0, 1.0]), [5, 5]);
        assert_eq!(shares(3, &[1.0, 1.0]), [2, 1]);
        assert_eq!(shares(100, &[9.0, 1.0, 90.0]), [9, 1, 90]);
        assert_eq!(shares(5, &[1000.0, 1e-9]), [5, 0]);
        assert_eq!(shares(0, &[1.0, 2.0]), [0, 0]);
        let members = vec![counter("slow", 30, u32::MAX), counter("fast", 0, u32::MAX)];
        let mut team = Team::new(members).unwrap();
        rendered(&mut team, 2000).unwrap();
        let done = |i: usize| team.members[i].backend.times().render_s;
        assert!(done(1) > 2.0 * done(0), "{} {}", done(0), done(1));
    }
}
