byId("costs").hidden = !summary;
if (summary) {
  const { costs, radio, advisories } = summary;
  byId("costs-tiles").append(
    tile("Broken off", counted(costs.go_arounds, "go-around"), counted(costs.rejected_takeoffs, "rejected take-off"), "whoever caused it"),
    tile("Off the planned level", `${whole(costs.level_deviation_ft_s)} ft s`, "", "distance integrated over the time en route, of all aircraft"),
    tile("Off the planned path", `${fixed(costs.path_deviation_nm_s, 2)} NM s`, "", "likewise, lateral distance"),
    tile("Frequency occupied", seconds(radio.occupied_s), counted(radio.transmissions, "transmission"), `${counted(radio.clarifications, "call")} to say again or to confirm`),
    tile("Advisories", whole(advisories.length), known(costs.advisories_per_hour) ? `${fixed(costs.advisories_per_hour, 1)} an hour` : "", `spoken for ${seconds(costs.advice_spoken_s)}`),
  );
}
