// Moments of a recorded run at which people at seats perceived, acted and answered.

import { known, words } from "./words.js";

function ofReaction({ seat, reaction }) {
  const about = [reaction.severity, words(reaction.advised ?? "")].filter((part) => part).join(", "),
    began = reaction.counted_from === "seen" ? reaction.t_seen_s : reaction.t_heard_s;
  return [
    { t: reaction.t_seen_s, text: `${seat} sees ${about}` },
    { t: reaction.t_heard_s, text: `${seat} hears ${about}` },
    {
      t: known(reaction.reaction_time_s) && known(began) ? began + reaction.reaction_time_s : null,
      text: `${seat} reacts to ${about}: ${words(reaction.first_action ?? "")}`,
    },
  ];
}

function ofRating({ seat, rating }) {
  return known(rating.rating)
    ? { t: rating.t_s + rating.answered_after_s, text: `${seat} answers: workload ${rating.rating}` }
    : { t: rating.t_s, text: `${seat} does not answer for the workload` };
}

/** The moments of people that a summary has; none in a run that goes on. */
export function personMoments(people = []) {
  const found = people.flatMap(({ seat, reactions, workload }) => [
    ...reactions.flatMap((reaction) => ofReaction({ seat, reaction })),
    ...(workload?.isa ?? []).map((rating) => ofRating({ seat, rating })),
  ]);
  return found.filter(({ t }) => known(t)).map((moment) => ({ ...moment, kind: "person" }));
}
