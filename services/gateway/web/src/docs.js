// The API page. The validator badge would ask a foreign host, so it is off.
/** @type {any} */ (window).SwaggerUIBundle({
  url: "/v1/openapi.json",
  dom_id: "#api",
  validatorUrl: null,
  deepLinking: false,
  defaultModelsExpandDepth: 0,
});
